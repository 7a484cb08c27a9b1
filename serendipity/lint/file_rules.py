"""Findings that take files: names and requirements that nothing uses, actions that are never applied."""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from serendipity.lint.report import Finding
from serendipity.lint.task_rules import listed
from serendipity.model import Task
from serendipity.pddl.grounding.quantifiers import literals
from serendipity.pddl.parsing import lifted
from serendipity.pddl.parsing.files import read_text


def file_findings(task: Task, units: Sequence[lifted.Unit]) -> Iterator[Finding]:
    """All findings for which files are needed."""
    yield from _missing_goals(units)
    yield from _actions(task, units)
    yield from _predicates(units)
    yield from _functions(units)
    yield from requirement_findings(units)


def _missing_goals(units: Sequence[lifted.Unit]) -> Iterator[Finding]:
    if all(unit.problem.goal_line is None for unit in units):
        files = listed([unit.problem_file for unit in units])
        yield Finding("warning", "goal-missing", f"no :goal in {files}")


def _actions(task: Task, units: Sequence[lifted.Unit]) -> Iterator[Finding]:
    applied = {action.key[0] for action in task.actions}
    never = {
        s.name: None for unit in units for s in unit.domain.schemas if s.all_effects and s.name not in applied
    }
    if never and not task.script.people:  # what they could do besides is in no task
        text = f"actions that can never be applied: {listed([*never])}"
        yield Finding("warning", "action-never-applied", text)


def _predicates(units: Sequence[lifted.Unit]) -> Iterator[Finding]:
    declared = {name: None for unit in units for name in unit.domain.predicates}
    schemas = [schema for unit in units for schema in unit.domain.schemas]
    read = {literal.key[0] for literal in _read(units, schemas)}
    needed = {literal.key[0] for literal in _read(units, schemas) if literal.positive}
    effects = [effect.literal for schema in schemas for effect in schema.all_effects]
    effects += [timed.literal for unit in units for timed in unit.problem.timed]
    changed = {literal.key[0] for literal in effects}
    made = {literal.key[0] for literal in effects if literal.positive}
    initial = {key[0] for unit in units for key in unit.problem.init}
    kinds = (
        ("note", "predicate-unused", "predicates that nothing uses", declared.keys() - read - changed),
        ("note", "predicate-unread", "predicates that are changed and never asked for", changed - read),
        (
            "warning",
            "predicate-false",
            "predicates that are asked for and never true",
            needed - made - initial,
        ),
    )
    for level, rule, words, names in kinds:
        if names:
            yield Finding(level, rule, f"{words}: {listed(sorted(names))}")


def _functions(units: Sequence[lifted.Unit]) -> Iterator[Finding]:
    declared = {name for unit in units for name in unit.domain.functions} - {"total-cost"}
    costs = [cost for unit in units for s in unit.domain.schemas for cost in (*s.increases, *_durations(s))]
    unread = declared - {name for cost in costs for name in _names(cost)}
    if unread:
        text = f"functions that no cost or duration depends on: {listed(sorted(unread))}"
        yield Finding("note", "function-unread", text)


def _durations(schema: lifted.Schema) -> Iterable[lifted.Expression]:
    return () if schema.course is None else (*schema.course.least, *schema.course.most)


def _read(units: Sequence[lifted.Unit], schemas: Iterable[lifted.Schema]) -> Iterator[lifted.Literal]:
    for unit in units:
        yield from literals(unit.problem.goal)
    for schema in schemas:
        for condition in schema.conditions:
            yield from literals(condition)
        for effect in schema.all_effects:
            if effect.condition is not None:
                yield from literals(effect.condition)


def _names(expression: lifted.Expression) -> Iterator[str]:
    match expression:
        case lifted.FunctionValue():
            yield expression.key[0]
        case lifted.Operation():
            for value in expression.values:
                yield from _names(value)


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

_OTHERS: Final = (":action-costs", ":durative-actions", ":timed-initial-literals")

_CHECKED: Final = {*_PARTS[":adl"], *_PARTS[":quantified-preconditions"], *_OTHERS} - {":strips"}
"""The requirements of which this module knows whether they are used."""


def requirement_findings(units: Sequence[lifted.Unit]) -> Iterator[Finding]:
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


def _used(unit: lifted.Unit) -> Iterator[str]:
    if unit.priced:
        yield ":action-costs"
    yield from _of(unit.problem.goal)
    if unit.problem.timed:
        yield ":timed-initial-literals"
    for schema in unit.domain.schemas:
        if schema.course is not None:
            yield ":durative-actions"
        for condition in schema.conditions:
            yield from _of(condition)
        for effect in schema.all_effects:
            if effect.condition is not None:
                yield ":conditional-effects"
                yield from _of(effect.condition)
            elif effect.parameters:
                yield ":conditional-effects"


def _of(formula: lifted.Formula) -> Iterator[str]:
    match formula:
        case lifted.Literal():
            if formula.key[0] == lifted.EQUALITY:
                yield ":equality"
            elif not formula.positive:
                yield ":negative-preconditions"
        case lifted.And() | lifted.Or():
            if isinstance(formula, lifted.Or):
                yield ":disjunctive-preconditions"
            for part in formula.parts:
                yield from _of(part)
        case lifted.Quantified():
            yield ":universal-preconditions" if formula.universal else ":existential-preconditions"
            yield from _of(formula.body)
