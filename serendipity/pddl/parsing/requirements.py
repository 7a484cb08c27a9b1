"""The section ``(:requirements ...)`` of a PDDL file."""

from typing import Final

from serendipity.model import InputError
from serendipity.pddl.parsing.tree import SExpression, expected, quoted

SUPPORTED: Final = frozenset(
    {
        ":strips",
        ":typing",
        ":equality",
        ":negative-preconditions",
        ":disjunctive-preconditions",
        ":existential-preconditions",
        ":universal-preconditions",
        ":quantified-preconditions",
        ":conditional-effects",
        ":adl",
        ":action-costs",
        ":fluents",
        ":numeric-fluents",
        ":multi-agent",
        ":unfactored-privacy",
        ":factored-privacy",
        ":durative-actions",
        ":duration-inequalities",
        ":timed-initial-literals",
    }
)
"""Supported requirements; of both kinds of fluents action costs only: others are refused where used."""

UNSUPPORTED: Final = {
    ":derived-predicates": "derived predicates",
    ":domain-axioms": "axioms",
    ":continuous-effects": "continuous effects",
    ":time": "processes and events",
    ":timed-initial-fluents": "timed initial fluents",
    ":object-fluents": "object fluents",
    ":preferences": "preferences",
    ":constraints": "trajectory constraints",
    ":goal-utilities": "goal utilities",
    ":probabilistic-effects": "probabilistic effects",
    ":mdp": "probabilistic effects",
    ":rewards": "rewards",
    ":non-deterministic": "non-deterministic effects",
    ":partial-observability": "partial observability",
    ":concurrency-network": "concurrency constraints",
}
"""Requirements that other planners know, in words."""


def read_requirements(section: SExpression) -> frozenset[str]:
    """The words of a section ``(:requirements ...)``.

    Raises:
        InputError: one is not supported, or not known; with the line.
    """
    found: set[str] = set()
    for i in range(1, len(section.items)):
        item = section.items[i]
        if not isinstance(item, str) or item[0] != ":":
            raise expected("a requirement, as ':typing'", section, i)
        if item not in SUPPORTED:
            problem = f"requirement {quoted(item)} is not known"
            if item in UNSUPPORTED:
                problem = f"{UNSUPPORTED[item]} ({quoted(item)}) are not supported"
            remedy = "remove the requirement if the files do without"
            raise InputError(f"{problem}; {remedy}", line=section.line_of(i))
        found.add(item)
    return frozenset(found)
