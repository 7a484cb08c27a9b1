"""Requirements that domains declare, beside those that they use."""

import re
from collections.abc import Iterator, Sequence
from typing import Final

from serendipity.lint.report import Finding
from serendipity.pddl.parsing.files import read_text
from serendipity.pddl.parsing.lifted import EQUALITY, And, Formula, Literal, Or, Quantified, Unit

_COMMENT: Final = re.compile(r";[^\n]*")
_SECTION: Final = re.compile(r"\(\s*:requirements\b([^()]*)\)", re.IGNORECASE)
_TYPES: Final = re.compile(r"\(\s*:types\s+[^\s)]", re.IGNORECASE)

_PARTS: Final = {
    ":adl": (
        ":strips",
        ":typing",
        ":negative-preconditions",
        ":disjunctive-preconditions",
        ":equality",
        ":quantified-preconditions",
        ":conditional-effects",
    ),
    ":quantified-preconditions": (":existential-preconditions", ":universal-preconditions"),
}
"""Requirements that stand for others (PDDL 2.1, Fox and Long 2003)."""

_CHECKED: Final = {*_PARTS[":adl"], *_PARTS[":quantified-preconditions"], ":action-costs"} - {":strips"}
"""The requirements of which this module knows whether they are used."""


def requirement_findings(units: Sequence[Unit]) -> Iterator[Finding]:
    """Requirements that are declared and not used, and the other way round, in each domain."""
    for unit in {unit.domain_file: unit for unit in units}.values():
        text = _COMMENT.sub("", read_text(unit.domain_file))
        section = _SECTION.search(text)
        if section is None:  # nobody minds
            continue
        declared = frozenset(section[1].lower().split())
        used = {*_used(unit), *([":typing"] if _TYPES.search(text) else [])}
        known = _whole(declared)
        missing = sorted(used - known)
        idle = sorted(name for name in declared & _CHECKED if not used & _whole({name}))
        if missing:
            words = f"{unit.domain_file} uses {', '.join(missing)} and does not require it"
            yield Finding("note", "requirement-missing", words)
        if idle:
            words = f"{unit.domain_file} requires {', '.join(idle)} and does not use it"
            yield Finding("note", "requirement-unused", words)


def _whole(names: frozenset[str] | set[str]) -> set[str]:
    """Requirements with all that they stand for."""
    found: set[str] = set()
    pending = [*names]
    while pending:
        name = pending.pop()
        found.add(name)
        pending += [part for part in _PARTS.get(name, ()) if part not in found]
    return found


def _used(unit: Unit) -> Iterator[str]:
    if unit.priced:
        yield ":action-costs"
    yield from _of(unit.problem.goal)
    for schema in unit.domain.schemas:
        yield from _of(schema.precondition)
        for effect in schema.effects:
            if effect.condition is not None:
                yield ":conditional-effects"
                yield from _of(effect.condition)
            elif effect.parameters:
                yield ":conditional-effects"


def _of(formula: Formula) -> Iterator[str]:
    match formula:
        case Literal():
            if formula.key[0] == EQUALITY:
                yield ":equality"
            elif not formula.positive:
                yield ":negative-preconditions"
        case And() | Or():
            if isinstance(formula, Or):
                yield ":disjunctive-preconditions"
            for part in formula.parts:
                yield from _of(part)
        case Quantified():
            yield ":universal-preconditions" if formula.universal else ":existential-preconditions"
            yield from _of(formula.body)
