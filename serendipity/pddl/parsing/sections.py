"""A file's sections."""

from dataclasses import dataclass, field
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.parsing.syntax import DURATIVE
from serendipity.pddl.parsing.tree import (
    SExpression,
    expected,
    name_at,
    node_at,
    quoted,
    read_tree,
    refuse_more,
)
from serendipity.pddl.work import Work

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
    """The words of a section ``(:requirements ...)``."""
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


ACTIONS: Final = (":action", DURATIVE)

_SECTIONS: Final = {
    "domain": (":requirements", ":types", ":constants", ":predicates", ":functions", *ACTIONS),
    "problem": (":requirements", ":domain", ":objects", ":init", ":goal", ":metric"),
}

_UNSUPPORTED: Final = {
    ":derived": "derived predicates",
    ":axiom": "axioms",
    ":process": "processes",
    ":event": "events",
    ":constraints": "trajectory constraints",
    ":goal-reward": "goal rewards",
    ":concurrency-constraint": "concurrency constraints",
}


@dataclass(slots=True)
class PddlFile:
    """A file ``(define (KIND NAME) SECTION ...)``; its sections but actions are there by keyword."""

    name: str
    requirements: frozenset[str] = frozenset()
    sections: dict[str, SExpression] = field(default_factory=dict)
    actions: list[SExpression] = field(default_factory=list)

    def section(self, keyword: str) -> SExpression:
        """A section; where there is none, one with nothing in it."""
        return self.sections.get(keyword) or SExpression(1)


def read_form(text: str, kind: str, work: Work) -> PddlFile:
    """The sections of a file of a kind, ``domain`` or ``problem``."""
    tree = read_tree(text, work)
    if not tree.items:
        raise InputError(f"the file is empty: expected '(define ({kind} ...'")
    define = node_at(tree, 0, f"'(define ({kind} ...'")
    if define.head != "define":
        raise expected("'define'", define, 0)
    if len(tree.items) > 1:
        raise expected("the end of the file after the last ')'", tree, 1)
    title = node_at(define, 1, f"'({kind} NAME)'")
    if title.head != kind:
        raise expected(f"'{kind}'", title, 0)
    form = PddlFile(name_at(title, 1, f"the name of the {kind}"))
    refuse_more(title, 2)
    for i in range(2, len(define.items)):
        _add_section(form, node_at(define, i, f"a section of a {kind}"), kind)
    return form


def _add_section(form: PddlFile, section: SExpression, kind: str) -> None:
    keyword = section.head
    if keyword in ACTIONS and kind == "domain":
        form.actions.append(section)
        return
    if not isinstance(keyword, str) or keyword not in _SECTIONS[kind]:
        if isinstance(keyword, str) and keyword in _UNSUPPORTED:
            message = f"{_UNSUPPORTED[keyword]} ({quoted(keyword)}) are not supported"
            raise InputError(message, line=section.line)
        raise expected(f"a section of a {kind}", section, 0)
    before = form.sections.setdefault(keyword, section)
    if before is not section:
        raise InputError(f"'{keyword}' was given already in line {before.line}", line=section.line)
    if keyword == ":requirements":
        form.requirements = read_requirements(section)
