"""A search-and-rescue task (the paper's section II): who and what is where, and all of it as PDDL text.

It has the semantics of the paper's 200 problems.  Every action costs 1 (the domain has no costs).
``conduct_triage`` is the human's alone and does not use the kit up; ``hand_over`` is joint, between two
agents in one place.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from serendipity.model import UsageError
from serendipity.scenarios.building import Building

HUMAN: Final = "commx"


@dataclass(frozen=True, slots=True)
class Usar:
    """A building, its agents, its medkits, and where the human has to conduct triage.

    Attributes:
        name: the PDDL problem's name.
        building: the map.
        robots: names of the robots; the human is ``commx``.
        agents_at: location of each agent, the human first.
        medkits_at: location of each medkit: ``mk1``, ``mk2``...
        triage_in: where the human has to conduct triage.

    Raises:
        UsageError: a location is not in the building, or positions and agents differ in number.
    """

    name: str
    building: Building
    robots: tuple[str, ...]
    agents_at: tuple[str, ...]
    medkits_at: tuple[str, ...]
    triage_in: str

    def __post_init__(self) -> None:
        if len(self.agents_at) != len(self.robots) + 1:
            raise UsageError("usar: expected one position for each agent")
        known = set(self.building.locations)
        for place in (*self.agents_at, *self.medkits_at, self.triage_in):
            if place not in known:
                raise UsageError(f"usar: there is no location '{place}' in the building")

    @property
    def agents(self) -> dict[str, str]:
        """Location of each agent by name, the human first."""
        return dict(zip((HUMAN, *self.robots), self.agents_at, strict=True))

    @property
    def medkits(self) -> dict[str, str]:
        """Location of each medkit by name."""
        return {f"mk{i}": place for i, place in enumerate(self.medkits_at, start=1)}


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
