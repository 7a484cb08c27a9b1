"""Schemas to operators, and conditions to disjunctive normal form.

What every way to do an action needs becomes the operator's precondition: ``forall``
is a conjunction over the objects of the type, ``exists`` a parameter that the action's
name does not show.  Disjunctions stay formulas; they are expanded for each ground
action, when static facts have decided most of them.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import count, product
from typing import Final

from serendipity.pddl.lifted import (
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

MAX_CASES: Final = 256
"""The most cases that one ground action's conditions, or its effects, may have."""

Clause = frozenset[Literal]
"""A conjunction of literals that contradict neither each other nor static facts."""

Decide = Callable[[Literal], bool | None]
"""The truth of a ground literal, or None where it depends on the state."""


class TooManyCasesError(Exception):
    """A condition has more than ``MAX_CASES`` disjuncts."""


@dataclass(frozen=True, slots=True)
class Operator:
    """A schema whose conditions are sorted out.

    Attributes:
        schema: the action.
        parameters: declared ones, then hidden ones.
        precondition: literals, equalities among them.
        choices: further conditions, disjunctive ones.
        effects: unconditional effects.
        conditional: pairs of a condition and the effect that it has.
    """

    schema: Schema
    parameters: tuple[Parameter, ...]
    precondition: tuple[Literal, ...]
    choices: tuple[Formula, ...] = ()
    effects: tuple[Literal, ...] = ()
    conditional: tuple[tuple[Formula, Literal], ...] = ()


def operator(schema: Schema, unit: Unit) -> Operator:
    """The operator of a schema over the objects of its own files."""
    needs = _Needs(unit)
    needs.collect(schema.precondition)
    simple, conditional = _expand_effects(schema.effects, unit)
    return Operator(
        schema,
        (*schema.parameters, *needs.hidden),
        tuple(needs.literals),
        tuple(needs.choices),
        simple,
        conditional,
    )


@dataclass(slots=True)
class _Needs:
    """What a condition needs in every case, and the choices that it leaves."""

    unit: Unit
    literals: list[Literal] = field(default_factory=list)
    choices: list[Formula] = field(default_factory=list)
    hidden: list[Parameter] = field(default_factory=list)
    fresh: Iterator[int] = field(default_factory=count)

    def collect(self, formula: Formula) -> None:
        match formula:
            case Literal():
                self.literals.append(formula)
            case And(parts):
                for part in parts:
                    self.collect(part)
            case Or((part,)):
                self.collect(part)
            case Or():
                self.choices.append(formula)
            case Quantified(True, parameters, body):
                for values in assignments(parameters, self.unit):
                    self.collect(substitute(body, values))
            case Quantified(_, parameters, body):
                renaming = {p.name: f"{p.name} {next(self.fresh)}" for p in parameters}
                self.hidden += [Parameter(renaming[p.name], p.type) for p in parameters]
                self.collect(substitute(body, renaming))


def _expand_effects(
    effects: tuple[Effect, ...], unit: Unit
) -> tuple[tuple[Literal, ...], tuple[tuple[Formula, Literal], ...]]:
    """The unconditional effects, and the others with their conditions, without ``forall``."""
    simple: list[Literal] = []
    conditional: list[tuple[Formula, Literal]] = []
    for effect in effects:
        if effect.condition is None and not effect.parameters:
            simple.append(effect.literal)
            continue
        for values in assignments(effect.parameters, unit):
            literal = Literal(ground_key(effect.literal.key, values), effect.literal.positive)
            if effect.condition is None:
                simple.append(literal)
            else:
                conditional.append((substitute(effect.condition, values), literal))
    return tuple(simple), tuple(conditional)


def clauses(formula: Formula, unit: Unit, decide: Decide) -> list[Clause]:
    """The disjuncts of a ground condition: none if it is false, an empty one if it is true.

    Raises:
        TooManyCasesError: there are more than ``MAX_CASES``.
    """
    match formula:
        case Literal():
            truth = decide(formula)
            if truth is None:
                return [frozenset((formula,))]
            return [frozenset()] if truth else []
        case And(parts):
            return conjunction(clauses(part, unit, decide) for part in parts)
        case Or(parts):
            return _disjunction(clauses(part, unit, decide) for part in parts)
        case Quantified(universal, parameters, body):
            instances = (
                clauses(substitute(body, values), unit, decide) for values in assignments(parameters, unit)
            )
            return conjunction(instances) if universal else _disjunction(instances)


def conjunction(parts: Iterable[list[Clause]]) -> list[Clause]:
    """The disjuncts of the conjunction of some disjunctions.

    Raises:
        TooManyCasesError: there are more than ``MAX_CASES``.
    """
    certain: set[Literal] = set()
    choices: list[list[Clause]] = []
    for part in parts:
        if len(part) == 1:
            certain |= part[0]
        else:
            choices.append(part)
    merged = [frozenset(certain)] if consistent(certain) else []
    for choice in choices:
        both = (a | b for a in merged for b in choice)
        merged = _minimal(clause for clause in both if consistent(clause))
    return merged


def consistent(literals: Iterable[Literal]) -> bool:
    """Whether no literal's negation is among the others."""
    literals = set(literals)
    return not any(Literal(key, not positive) in literals for key, positive in literals)


def _disjunction(parts: Iterable[list[Clause]]) -> list[Clause]:
    return _minimal(clause for part in parts for clause in part)


def _minimal(found: Iterable[Clause]) -> list[Clause]:
    """The clauses that no other one is part of, in order of first occurrence."""
    kept: list[Clause] = []
    for clause in found:
        if not any(other <= clause for other in kept):
            kept = [other for other in kept if not clause <= other]
            kept.append(clause)
            if len(kept) > MAX_CASES:
                raise TooManyCasesError
    return kept


def assignments(parameters: tuple[Parameter, ...], unit: Unit) -> Iterator[dict[str, str]]:
    """Every assignment of objects to parameters."""
    domains = [unit.objects_of(p.type) for p in parameters]
    for objects in product(*domains):
        yield dict(zip((p.name for p in parameters), objects, strict=True))


def substitute(formula: Formula, values: dict[str, str]) -> Formula:
    """The formula with variables replaced; an inner quantifier shadows."""
    if not values:
        return formula
    match formula:
        case Literal(key, positive):
            return Literal(ground_key(key, values), positive)
        case And(parts):
            return And(tuple([substitute(part, values) for part in parts]))
        case Or(parts):
            return Or(tuple([substitute(part, values) for part in parts]))
        case Quantified(universal, parameters, body):
            own = {p.name for p in parameters}
            outer = {name: value for name, value in values.items() if name not in own}
            return Quantified(universal, parameters, substitute(body, outer))


def ground_key(key: Key, values: dict[str, str]) -> Key:
    """The atom with variables replaced."""
    if not values:
        return key
    return (key[0], *[values.get(term, term) for term in key[1:]])
