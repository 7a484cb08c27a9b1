"""Files' sections to checked lifted values.

Errors carry the line; the caller adds the file.
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from graphlib import CycleError, TopologicalSorter
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.parsing.durative import DurativeReader
from serendipity.pddl.parsing.initial import read_initial
from serendipity.pddl.parsing.lifted import And, Domain, Formula, Problem, Schema
from serendipity.pddl.parsing.scope import TOTAL_COST, Scope, check_type, cost_fault
from serendipity.pddl.parsing.sections import PddlFile, read_form
from serendipity.pddl.parsing.syntax import VARIABLE, Typed, read_action, signatures, typed_list
from serendipity.pddl.parsing.tree import SExpression, expected, name_at, naming, node_at, quoted, refuse_more
from serendipity.pddl.parsing.types import MAX_LEVELS, OBJECT, Type, Types, type_text
from serendipity.pddl.work import Work

TOTAL_TIME: Final = "total-time"

_KEPT: Final = 64

_domains: Final[dict[str, Domain]] = {}  # a cache: those read last, by their texts


def read_domain(text: str, work: Work) -> Domain:
    """The checked domain that a text defines; equal texts are read once."""
    domain = _domains.pop(text, None) or _domain(read_form(text, "domain", work), work)
    _domains[text] = domain
    if len(_domains) > _KEPT:
        _domains.pop(next(iter(_domains)), None)
    return domain


def forget_parsed() -> None:
    """Forget the domains that were read, for measurements; equal texts are read once else."""
    _domains.clear()


def read_problem(text: str, domain: Domain, work: Work) -> Problem:
    """The checked problem that a text defines for a domain."""
    form = read_form(text, "problem", work)
    empty: list[int] = []
    listed = typed_list(form.section(":objects"), 1, "an object", 1 if domain.factored else 2, empty)
    objects = _objects(listed, domain.types, domain.constants)
    scope = Scope(domain.types, domain.predicates, domain.functions, objects, work)
    with naming("initial state"):
        initial = read_initial(form.section(":init"), scope, work)
    goal = form.sections.get(":goal")
    metric = _metric(form.sections.get(":metric"), domain)
    return Problem(
        form.name,
        _domain_name(form),
        objects,
        initial.true,
        initial.false,
        initial.values,
        And() if goal is None else _goal(goal, scope),
        None if goal is None else goal.line,
        metric == TOTAL_COST,
        tuple(empty),
        tuple(initial.timed),
        metric == TOTAL_TIME,
    )


def _domain(form: PddlFile, work: Work) -> Domain:
    types = _types(typed_list(form.section(":types"), 1, "a type"))
    factored = ":factored-privacy" in form.requirements
    private = 1 if factored else 2
    empty: list[int] = []
    listed = typed_list(form.section(":constants"), 1, "an object", private, empty)
    constants = _objects(listed, types, {})
    predicates = _signatures(form.section(":predicates"), "predicate", types, work)
    functions = _signatures(form.section(":functions"), "function", types, work)
    schemas: dict[str, Schema] = {}
    for section in work.deadline.each(form.actions):
        schema = _schema(section, Scope(types, predicates, functions, constants, work))
        first = schemas.setdefault(schema.name, schema)
        if first is not schema:
            message = f"action {quoted(schema.name)} is defined already in line {first.line}"
            raise InputError(message, line=schema.line)
    return Domain(
        form.name, types, constants, predicates, functions, tuple(schemas.values()), factored, tuple(empty)
    )


def _signatures(section: SExpression, what: str, types: Types, work: Work) -> dict[str, tuple[Type, ...]]:
    found: dict[str, tuple[Type, ...]] = {}
    for name, line, parameters in work.deadline.each(signatures(section, what)):
        with naming(f"{what} {quoted(name)}"):
            for typed in parameters:
                check_type(typed.type, types, typed.line)
        signature = tuple(typed.type for typed in parameters)
        if found.setdefault(name, signature) != signature:
            raise InputError(f"{what} {quoted(name)} is declared twice, in different ways", line=line)
    return found


def _schema(section: SExpression, scope: Scope) -> Schema:
    text = read_action(section)
    agent = [] if text.agent is None else [text.agent]
    nothing = SExpression(text.line)
    with naming(f"action {quoted(text.name)}"):
        own = typed_list(text.parts.get(":parameters", nothing), 0, VARIABLE)
        parameters = scope.parameters([*agent, *own])
        course = None
        if text.durative:
            reader = DurativeReader(scope)
            precondition, effects, increases, course = reader.read(text.parts)
        else:
            precondition = scope.condition(text.parts.get(":precondition", nothing))
            effects, increases = scope.effects(text.parts[":effect"])
        for value in increases:
            fault = cost_fault(value) if isinstance(value, Fraction) else None
            if fault is not None:
                raise InputError(fault, line=text.line)
    return Schema(
        text.name,
        text.line,
        parameters,
        precondition,
        tuple(effects),
        tuple(increases),
        text.agent is not None,
        scope.quantified,
        course,
    )


def _types(listed: Iterable[Typed]) -> Types:
    parents: dict[str, Type] = {}
    lines: dict[str, int] = {}
    for name, parent, line in listed:
        if name in lines and parents.get(name, parent) != parent:
            raise InputError(f"type {quoted(name)} is declared twice, in different ways", line=line)
        lines[name] = line
        if name != OBJECT:
            parents[name] = parent
    for above in list(parents.values()):
        for name in above:
            if name != OBJECT:
                parents.setdefault(name, (OBJECT,))
    _refuse_heights(parents, lines)
    return Types(parents)


def _refuse_heights(parents: Mapping[str, Type], lines: Mapping[str, int]) -> None:
    """Refuse circles, and hierarchies that are too high."""
    try:
        lowest_last = [*TopologicalSorter(parents).static_order()]
    except CycleError as error:
        name = min(error.args[1], key=lambda name: (lines.get(name, 0), name))
        raise InputError(f"type {quoted(name)} is its own supertype", line=lines.get(name)) from None
    levels = {OBJECT: 0}
    for name in lowest_last:
        levels[name] = 1 + max((levels[above] for above in parents.get(name, ())), default=-1)
        if levels[name] > MAX_LEVELS:
            message = f"types are nested too deeply: at most {MAX_LEVELS} above one another"
            raise InputError(message, line=lines.get(name))


def _objects(listed: Iterable[Typed], types: Types, known: Mapping[str, Type]) -> dict[str, Type]:
    objects = dict(known)
    for name, kind, line in listed:
        with naming(f"object {quoted(name)}"):
            check_type(kind, types, line)
        before = objects.get(name, kind)
        if not types.comparable(before, kind):
            both = f"'{type_text(before)}' and as '{type_text(kind)}'"
            raise InputError(f"object {quoted(name)} is declared as {both}", line=line)
        objects[name] = kind if types.is_subtype(kind, before) else before
    return objects


def _domain_name(form: PddlFile) -> str | None:
    section = form.sections.get(":domain")
    if section is None:
        return None
    refuse_more(section, 2)
    return name_at(section, 1, "the name of the domain")


def _goal(section: SExpression, scope: Scope) -> Formula:
    refuse_more(section, 2)
    with naming("goal"):
        return And() if len(section.items) < 2 else scope.condition(node_at(section, 1, "a condition"))


def _metric(section: SExpression | None, domain: Domain) -> str | None:
    """What is minimised: ``total-cost``, ``total-time``, or None where nothing is said."""
    if section is None:
        return None
    if section.items[1:2] not in (["minimize"], ["maximize"]):
        raise expected("'minimize'", section, 1)
    refuse_more(section, 3)
    total = node_at(section, 2, f"'({TOTAL_COST})'")
    durative = any(schema.course is not None for schema in domain.schemas)
    if section.items[1] == "minimize" and durative and total.items == [TOTAL_TIME]:
        return TOTAL_TIME
    if section.items[1] != "minimize" or total.items != [TOTAL_COST]:
        also = f" and 'minimize ({TOTAL_TIME})'" if durative else ""
        message = f"the only metric supported is 'minimize ({TOTAL_COST})'{also}"
        raise InputError(message, line=section.line)
    return TOTAL_COST
