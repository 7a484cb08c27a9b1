"""Findings that take files: names that are declared and not used, and actions that can never be applied."""

from collections.abc import Iterable, Iterator, Sequence

from serendipity.lint.report import Finding
from serendipity.lint.requirements import requirement_findings
from serendipity.lint.task_rules import listed
from serendipity.model import Task
from serendipity.pddl.grounding.quantifiers import literals
from serendipity.pddl.parsing.lifted import Expression, FunctionValue, Literal, Operation, Schema, Unit


def file_findings(task: Task, units: Sequence[Unit]) -> Iterator[Finding]:
    """All findings for which files are needed.

    Args:
        task: that was read from them.
        units: domains and problems, one for each agent or for all.
    """
    yield from _missing_goals(units)
    yield from _actions(task, units)
    yield from _predicates(units)
    yield from _functions(units)
    yield from requirement_findings(units)


def _missing_goals(units: Sequence[Unit]) -> Iterator[Finding]:
    if all(unit.problem.goal_line is None for unit in units):
        files = listed([unit.problem_file for unit in units])
        yield Finding("warning", "goal-missing", f"no :goal in {files}")


def _actions(task: Task, units: Sequence[Unit]) -> Iterator[Finding]:
    applied = {action.key[0] for action in task.actions}
    never = {
        s.name: None for unit in units for s in unit.domain.schemas if s.effects and s.name not in applied
    }
    if never:
        text = f"actions that can never be applied: {listed([*never])}"
        yield Finding("warning", "action-never-applied", text)


def _predicates(units: Sequence[Unit]) -> Iterator[Finding]:
    declared = {name: None for unit in units for name in unit.domain.predicates}
    schemas = [schema for unit in units for schema in unit.domain.schemas]
    read = {literal.key[0] for literal in _read(units, schemas)}
    needed = {literal.key[0] for literal in _read(units, schemas) if literal.positive}
    changed = {effect.literal.key[0] for schema in schemas for effect in schema.effects}
    made = {e.literal.key[0] for schema in schemas for e in schema.effects if e.literal.positive}
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


def _functions(units: Sequence[Unit]) -> Iterator[Finding]:
    declared = {name for unit in units for name in unit.domain.functions} - {"total-cost"}
    costs = [cost for unit in units for schema in unit.domain.schemas for cost in schema.increases]
    unread = declared - {name for cost in costs for name in _names(cost)}
    if unread:
        text = f"functions that no cost depends on: {listed(sorted(unread))}"
        yield Finding("note", "function-unread", text)


def _read(units: Sequence[Unit], schemas: Iterable[Schema]) -> Iterator[Literal]:
    for unit in units:
        yield from literals(unit.problem.goal)
    for schema in schemas:
        yield from literals(schema.precondition)
        for effect in schema.effects:
            if effect.condition is not None:
                yield from literals(effect.condition)


def _names(expression: Expression) -> Iterator[str]:
    match expression:
        case FunctionValue():
            yield expression.key[0]
        case Operation():
            for value in expression.values:
                yield from _names(value)
