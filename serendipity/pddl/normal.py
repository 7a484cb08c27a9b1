"""Schemas to operators: conjunctive preconditions, no quantifiers.

A disjunction becomes several operators of one name, ``exists`` a parameter that the
action's name does not show, ``forall`` a conjunction over the objects of the type.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count, product
from typing import Final, TypeVar

from serendipity.pddl.lifted import (
    EQUALITY,
    And,
    Effect,
    Formula,
    Key,
    Literal,
    Or,
    Parameter,
    Quantified,
    Schema,
    Unit,
)

T = TypeVar("T")

MAX_DISJUNCTS: Final = 256
"""The most operators that one action may become."""


class TooManyCasesError(Exception):
    """A condition has more than ``MAX_DISJUNCTS`` disjuncts."""


@dataclass(frozen=True, slots=True)
class Clause:
    """A conjunction of literals over declared and hidden parameters."""

    literals: tuple[Literal, ...]
    hidden: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class Operator:
    """One conjunctive way to do an action.

    Attributes:
        schema: the action.
        parameters: declared ones, then hidden ones.
        precondition: literals, equalities among them.
        effects: unconditional effects.
        conditional: pairs of a conjunction and the effects that it has.
    """

    schema: Schema
    parameters: tuple[Parameter, ...]
    precondition: tuple[Literal, ...]
    effects: tuple[Literal, ...]
    conditional: tuple[tuple[tuple[Literal, ...], tuple[Literal, ...]], ...] = ()


def operators(schema: Schema, unit: Unit) -> list[Operator]:
    """The operators of a schema over the objects of its own files.

    Raises:
        InputError: it has too many cases.
    """
    if type(schema.precondition) is And and all(type(p) is Literal for p in schema.precondition.parts):
        clauses = [Clause(schema.precondition.parts)]  # type: ignore[arg-type]
    else:
        clauses = _guarded(schema, unit, lambda: Expander(unit).clauses(schema.precondition))
    simple = tuple([e.literal for e in schema.effects if e.condition is None and not e.parameters])
    conditional: tuple[tuple[tuple[Literal, ...], tuple[Literal, ...]], ...] = ()
    if len(simple) < len(schema.effects):
        simple, conditional = _guarded(schema, unit, lambda: _expand_effects(schema.effects, unit))
    return [Operator(schema, schema.parameters + c.hidden, c.literals, simple, conditional) for c in clauses]


def goal_clauses(goal: Formula, unit: Unit) -> list[Clause]:
    """The disjuncts of a goal, without quantifiers.

    Raises:
        InputError: it has too many cases.
    """
    try:
        return Expander(unit, hide=False).clauses(goal)
    except TooManyCasesError:
        raise unit.problem_error("the goal has too many cases", unit.problem.goal_line) from None


def _guarded(schema: Schema, unit: Unit, work: Callable[[], T]) -> T:
    try:
        return work()
    except TooManyCasesError:
        message = f"more than {MAX_DISJUNCTS} cases of its conditions are not supported"
        raise unit.domain_error(f"action '{schema.name}': {message}", schema.line) from None


class Expander:
    """Disjunctive normal form over the objects of a unit."""

    def __init__(self, unit: Unit, *, hide: bool = True) -> None:
        self.unit = unit
        self.hide = hide
        self.fresh = count()

    def clauses(self, formula: Formula) -> list[Clause]:
        """The disjuncts of a formula; ``exists`` gives hidden parameters if ``hide``."""
        match formula:
            case Literal():
                return [Clause((formula,))]
            case And(parts):
                return self._conjunction([self.clauses(part) for part in parts])
            case Or(parts):
                return _limited([clause for part in parts for clause in self.clauses(part)])
            case Quantified(True, parameters, body):
                return self._conjunction([self.clauses(b) for b in self.instances(parameters, body)])
            case Quantified(_, parameters, body) if self.hide:
                renaming = {p.name: f"{p.name} {next(self.fresh)}" for p in parameters}
                hidden = tuple(Parameter(renaming[p.name], p.type) for p in parameters)
                inner = self.clauses(substitute(body, renaming))
                return [Clause(clause.literals, hidden + clause.hidden) for clause in inner]
            case Quantified(_, parameters, body):
                instances = self.instances(parameters, body)
                return _limited([clause for b in instances for clause in self.clauses(b)])

    def instances(self, parameters: tuple[Parameter, ...], body: Formula) -> Iterator[Formula]:
        """The body once for each value of the parameters."""
        for values in self.values(parameters):
            yield substitute(body, values)

    def values(self, parameters: tuple[Parameter, ...]) -> Iterator[dict[str, str]]:
        """Every assignment of objects to parameters."""
        domains = [self.unit.objects_of(p.type) for p in parameters]
        for objects in product(*domains):
            yield dict(zip((p.name for p in parameters), objects, strict=True))

    def _conjunction(self, parts: list[list[Clause]]) -> list[Clause]:
        merged = [Clause(())]
        for alternatives in parts:
            merged = [
                Clause(a.literals + b.literals, a.hidden + b.hidden)
                for a in merged
                for b in alternatives
                if not _contradict(a.literals, b.literals)
            ]
            _limited(merged)
        return merged


def _limited(clauses: list[Clause]) -> list[Clause]:
    if len(clauses) > MAX_DISJUNCTS:
        raise TooManyCasesError
    return clauses


def _contradict(a: tuple[Literal, ...], b: tuple[Literal, ...]) -> bool:
    return len(b) == 1 and Literal(b[0].key, not b[0].positive) in a


def substitute(formula: Formula, values: dict[str, str]) -> Formula:
    """The formula with variables replaced; an inner quantifier shadows."""
    match formula:
        case Literal(key, positive):
            return Literal(_substituted(key, values), positive)
        case And(parts):
            return And(tuple(substitute(part, values) for part in parts))
        case Or(parts):
            return Or(tuple(substitute(part, values) for part in parts))
        case Quantified(universal, parameters, body):
            own = {p.name for p in parameters}
            outer = {name: value for name, value in values.items() if name not in own}
            return Quantified(universal, parameters, substitute(body, outer))


def _substituted(key: Key, values: dict[str, str]) -> Key:
    return (key[0], *(values.get(term, term) for term in key[1:]))


def _expand_effects(
    effects: tuple[Effect, ...], unit: Unit
) -> tuple[tuple[Literal, ...], tuple[tuple[tuple[Literal, ...], tuple[Literal, ...]], ...]]:
    """Effects without quantifiers: the unconditional, and the others by their condition."""
    expander = Expander(unit, hide=False)
    simple: list[Literal] = []
    conditional: dict[tuple[Literal, ...], list[Literal]] = {}
    for effect in effects:
        for values in expander.values(effect.parameters):
            literal = Literal(_substituted(effect.literal.key, values), effect.literal.positive)
            if effect.condition is None:
                simple.append(literal)
                continue
            for clause in expander.clauses(substitute(effect.condition, values)):
                conditional.setdefault(clause.literals, []).append(literal)
    return tuple(simple), tuple((when, tuple(then)) for when, then in conditional.items())


def is_equality(literal: Literal) -> bool:
    """Whether a literal compares two terms."""
    return literal.key[0] == EQUALITY
