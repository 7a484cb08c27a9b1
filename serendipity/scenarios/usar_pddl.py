"""The search-and-rescue task as PDDL text, with the semantics of the paper's 200 problems.

Every action costs 1 (the domain has no costs).  ``conduct_triage`` is the human's alone
and does not use the kit up; ``hand_over`` is joint, between two agents in one place.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.scenarios.usar import HUMAN, Usar

_TYPES: Final = """\
  (:types
    location thing - object
    agent medkit - thing
    person machine - agent)"""

_PREDICATES: Final = """\
  (:predicates
    (connected ?from ?to - location)
    (at ?what - thing ?where - location)
    (has ?who - agent ?kit - medkit)
    (has_medkit ?who - agent)
    (loc_has_medkit ?where - location)
    (delivered ?who - agent ?kit - medkit ?where - location)
    (conducted_triage ?who - person ?where - location))"""

_OWN_ACTIONS: Final = """\
  (:action move
    :parameters (?who - agent ?from ?to - location)
    :precondition (and (at ?who ?from) (connected ?from ?to))
    :effect (and (at ?who ?to) (not (at ?who ?from))))

  (:action move_reverse
    :parameters (?who - agent ?from ?to - location)
    :precondition (and (at ?who ?from) (connected ?to ?from))
    :effect (and (at ?who ?to) (not (at ?who ?from))))

  (:action pick_up_medkit
    :parameters (?who - agent ?kit - medkit ?where - location)
    :precondition (and (at ?who ?where) (at ?kit ?where))
    :effect (and (has_medkit ?who) (has ?who ?kit)
                 (not (at ?kit ?where)) (not (loc_has_medkit ?where))))

  (:action drop_off
    :parameters (?who - agent ?kit - medkit ?where - location)
    :precondition (and (at ?who ?where) (has ?who ?kit))
    :effect (and (delivered ?who ?kit ?where) (loc_has_medkit ?where) (at ?kit ?where)
                 (not (has ?who ?kit)) (not (has_medkit ?who))))"""

_TRIAGE: Final = """\
  (:action conduct_triage
    :parameters (?who - person ?where - location)
    :precondition (and (at ?who ?where) (has_medkit ?who))
    :effect (conducted_triage ?who ?where))"""

_HAND_OVER: Final = """\
  (:action hand_over
    :parameters (?giver ?taker - agent ?kit - medkit ?where - location)
    :precondition (and (not (= ?giver ?taker)) (at ?giver ?where) (at ?taker ?where)
                       (has_medkit ?giver) (has ?giver ?kit))
    :effect (and (has_medkit ?taker) (has ?taker ?kit)
                 (not (has ?giver ?kit)) (not (has_medkit ?giver))))"""


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
        "domain.pddl": _domain("usar", [_OWN_ACTIONS, _TRIAGE, _HAND_OVER], equality=True),
        "problem.pddl": _problem(task, "usar", task.agents),
    }


def _folders(task: Usar) -> dict[str, str]:
    files: dict[str, str] = {}
    for agent, place in task.agents.items():
        actions = [_OWN_ACTIONS, _TRIAGE] if agent == HUMAN else [_OWN_ACTIONS]
        files[f"{agent}/domain.pddl"] = _domain(f"usar-{agent}", actions)
        files[f"{agent}/problem.pddl"] = _problem(task, f"usar-{agent}", {agent: place})
    return files | {f"superagent/{path}": text for path, text in _pair(task).items()}


LAYOUTS: Final[dict[str, Callable[[Usar], dict[str, str]]]] = {"agents": _folders, "pair": _pair}
"""``agents``, the default: a folder per agent and ``superagent/``.  ``pair``: one domain and
one problem, agents are objects."""


def _domain(name: str, actions: Sequence[str], *, equality: bool = False) -> str:
    requirements = ":strips :typing" + (" :equality :negative-preconditions" if equality else "")
    head = [f"(define (domain {name})", f"  (:requirements {requirements})", _TYPES, _PREDICATES]
    return "\n".join(head) + "\n\n" + "\n\n".join(actions) + ")\n"


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
