"""The search-and-rescue task as PDDL text, with the semantics of the paper's 200 problems.

Every action costs 1 (the domain has no costs).  ``conduct_triage`` is the human's alone
and does not use the kit up; ``hand_over`` is joint, between two agents in one place.
"""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.scenarios.usar import HUMAN, Usar

_DOMAIN: Final = Path(__file__).parent / "data" / "usar" / "domain.pddl"
"""The domain of all agents; blank lines separate its head and its actions, and hand-over is the last."""


def pddl_files(task: Usar, layout: str = "agents") -> dict[str, str]:
    """The PDDL text of each file of a task, by its path inside the task's folder.

    Raises:
        UsageError: there is no such layout.
    """
    if layout not in LAYOUTS:
        raise UsageError(f"layout: expected one of {', '.join(LAYOUTS)}, got '{layout}'")
    return LAYOUTS[layout](task)


def _pair(task: Usar) -> dict[str, str]:
    return {
        "domain.pddl": _DOMAIN.read_text(encoding="utf-8"),
        "problem.pddl": _problem(task, "usar", task.agents),
    }


def _folders(task: Usar) -> dict[str, str]:
    files: dict[str, str] = {}
    for agent, place in task.agents.items():
        files[f"{agent}/domain.pddl"] = _own_domain(agent)
        files[f"{agent}/problem.pddl"] = _problem(task, f"usar-{agent}", {agent: place})
    return files | {f"superagent/{path}": text for path, text in _pair(task).items()}


LAYOUTS: Final[dict[str, Callable[[Usar], dict[str, str]]]] = {"agents": _folders, "pair": _pair}
"""``agents``, the default: a folder per agent and ``superagent/``.  ``pair``: one domain and
one problem, agents are objects."""


def _own_domain(agent: str) -> str:
    """The domain of what one agent can do alone, which compares no objects."""
    head, *actions, _ = _DOMAIN.read_text(encoding="utf-8").split("\n\n")
    head = head.replace("usar", f"usar-{agent}").replace(" :equality :negative-preconditions", "")
    own = [action for action in actions if agent == HUMAN or "conduct_triage" not in action]
    return "\n\n".join([head, *own]) + ")\n"


def _problem(task: Usar, domain: str, agents: dict[str, str]) -> str:
    """The problem as these agents know it; the goal is the human's."""
    lines = [f"(define (problem {task.name})", f"  (:domain {domain})", "  (:objects"]
    for kind, names in (
        ("location", task.building.locations),
        ("medkit", task.medkits),
        ("machine", [agent for agent in agents if agent != HUMAN]),
        ("person", [agent for agent in agents if agent == HUMAN]),
    ):
        lines += _wrapped(names, last=f"- {kind}")
    lines += ["  )", "  (:init"]
    lines += [f"    (connected {a} {b})" for a, b in task.building.connections]
    lines += [f"    (at {what} {place})" for what, place in (agents | task.medkits).items()]
    goal = f" (conducted_triage {HUMAN} {task.triage_in})" if HUMAN in agents else ""
    return "\n".join([*lines, "  )", f"  (:goal (and{goal})))"]) + "\n"


def _wrapped(names: Iterable[str], *, last: str, width: int = 12) -> list[str]:
    """Names over lines of ``width`` words, indented, closed by ``last``; none for no names."""
    words = list(names)
    if not words:
        return []
    words.append(last)
    return ["    " + " ".join(words[i : i + width]) for i in range(0, len(words), width)]
