"""Schemas to lifted actions, and conditions to disjunctive normal form.

What every way to do an action needs becomes its precondition: ``forall``
is a conjunction over the objects of the type, ``exists`` a parameter that the action's
name does not show.  Disjunctions stay formulas; they are expanded for each ground
action, when static facts have decided most of them.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Final

from serendipity.pddl.grounding.quantifiers import (
    assignments,
    ground_key,
    how_many,
    instances,
    simplified,
    simplified_effect,
    substitute,
)
from serendipity.pddl.parsing import lifted
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.work import Work, about

MAX_CASES: Final = 256
"""The most cases that one ground action's conditions, or its effects, may have."""

_BYTES: Final = 200
"""Of a literal in a condition or an effect, measured."""

_FEW: Final = 10_000
"""Literals that nobody need ask memory for."""

Clause = frozenset[lifted.Literal]
"""A conjunction of literals that contradict neither each other nor static facts."""

Decide = Callable[[lifted.Literal], bool | None]
"""The truth of a ground literal, or None where it depends on the state."""


class TooManyCasesError(Exception):
    """A condition has more than ``MAX_CASES`` disjuncts."""


@dataclass(frozen=True, slots=True)
class Lifted:
    """A schema whose conditions are sorted out.

    Attributes:
        parameters: declared ones, then hidden ones.
        precondition: literals, equalities among them.
        choices: further conditions, disjunctive ones.
        effects: unconditional effects; of a durative action those at end.
        over_all: literals that a durative action needs while it goes on.
        at_end: literals that it needs to end.
        start_effects: its effects at start.
    """

    schema: lifted.Schema
    parameters: tuple[lifted.Parameter, ...]
    precondition: tuple[lifted.Literal, ...]
    choices: tuple[lifted.Formula, ...] = ()
    effects: tuple[lifted.Literal, ...] = ()
    conditional: tuple[tuple[lifted.Formula, lifted.Literal], ...] = ()
    over_all: tuple[lifted.Literal, ...] = ()
    at_end: tuple[lifted.Literal, ...] = ()
    start_effects: tuple[lifted.Literal, ...] = ()

    @property
    def needs(self) -> tuple[lifted.Literal, ...]:
        """Literals that it needs at some time."""
        return (*self.precondition, *self.over_all, *self.at_end) if self.schema.course else self.precondition


def lifted_of(schema: lifted.Schema, unit: lifted.Unit, work: Work) -> Lifted:
    """The lifted action of a schema over the objects of its own files."""
    precondition: lifted.Formula = schema.precondition
    effects: Sequence[lifted.Effect] = schema.effects
    if schema.quantified:
        precondition = simplified(precondition, unit)
        effects = [e for effect in effects if (e := simplified_effect(effect, unit)) is not None]
        number = _expanded(precondition, unit)
        number += sum(
            how_many(e.parameters, unit) * instances(e.condition or e.literal, unit) for e in effects
        )
        require_literals(number, unit.place(schema), work)
    needs = _Needs(unit, work)
    needs.collect(precondition)
    simple, conditional = _expand_effects(effects, unit, work)
    parameters = (*schema.parameters, *needs.hidden)
    found = Lifted(schema, parameters, tuple(needs.literals), tuple(needs.choices), simple, conditional)
    return found if schema.course is None else _with_course(found, schema.course, unit, work)


def _with_course(found: Lifted, course: lifted.DurativeParts, unit: lifted.Unit, work: Work) -> Lifted:
    """The lifted action with its course; an InputError where it needs more than literals after its start."""
    over_all = _literals(found.schema, course.over_all, "over all", unit, work)
    at_end = _literals(found.schema, course.at_end, "at end", unit, work)
    at_start = [e for effect in course.start_effects if (e := simplified_effect(effect, unit)) is not None]
    start_effects, _ = _expand_effects(at_start, unit, work)
    return replace(found, over_all=over_all, at_end=at_end, start_effects=start_effects)


def _literals(
    schema: lifted.Schema, formula: lifted.Formula, when: str, unit: lifted.Unit, work: Work
) -> tuple[lifted.Literal, ...]:
    needs = _Needs(unit, work)
    needs.collect(simplified(formula, unit))
    if needs.choices or needs.hidden:
        message = f"action {quoted(schema.name)}: '{when}': expected no 'or', 'imply' and 'exists'"
        raise unit.domain_error(message, schema.line)
    return tuple(needs.literals)


def require_literals(number: int, place: str, work: Work) -> None:
    """Check that so many literals fit into memory."""
    if number > _FEW:
        work.require(
            number * _BYTES, f"reading {place} comes to {about(number)} literals without quantifiers"
        )


def _expanded(formula: lifted.Formula, unit: lifted.Unit) -> int:
    """The number of literals of a precondition; what exists becomes a parameter."""
    match formula:
        case lifted.And(parts) | lifted.Or((_,) as parts):
            return sum(_expanded(part, unit) for part in parts)
        case lifted.Quantified(False, _, body):
            return _expanded(body, unit)
        case lifted.Quantified(True, parameters, body):
            return how_many(parameters, unit) * _expanded(body, unit)
    return instances(formula, unit)


@dataclass(slots=True)
class _Needs:
    """The literals that a condition needs in every case, and the choices that it leaves."""

    unit: lifted.Unit
    work: Work
    literals: list[lifted.Literal] = field(default_factory=list)
    choices: list[lifted.Formula] = field(default_factory=list)
    hidden: list[lifted.Parameter] = field(default_factory=list)
    fresh: Iterator[int] = field(default_factory=count)

    def collect(self, formula: lifted.Formula) -> None:
        match formula:
            case lifted.Literal():
                self.literals.append(formula)
            case lifted.And(parts):
                for part in parts:
                    self.collect(part)
            case lifted.Or((part,)):
                self.collect(part)
            case lifted.Or():
                self.choices.append(formula)
            case lifted.Quantified(True, parameters, body):
                for values in assignments(parameters, self.unit):
                    self.work.deadline.tick()
                    self.collect(substitute(body, values))
            case lifted.Quantified(_, parameters, body):
                renaming = {p.name: f"{p.name} {next(self.fresh)}" for p in parameters}
                self.hidden += [lifted.Parameter(renaming[p.name], p.type) for p in parameters]
                self.collect(substitute(body, renaming))


def _expand_effects(
    effects: Iterable[lifted.Effect], unit: lifted.Unit, work: Work
) -> tuple[tuple[lifted.Literal, ...], tuple[tuple[lifted.Formula, lifted.Literal], ...]]:
    """The unconditional effects, and the others with their conditions, without ``forall``."""
    simple: list[lifted.Literal] = []
    conditional: list[tuple[lifted.Formula, lifted.Literal]] = []
    for effect in effects:
        if effect.condition is None and not effect.parameters:
            simple.append(effect.literal)
            continue
        for values in work.deadline.each(assignments(effect.parameters, unit)):
            literal = lifted.Literal(ground_key(effect.literal.key, values), effect.literal.positive)
            if effect.condition is None:
                simple.append(literal)
            else:
                conditional.append((substitute(effect.condition, values), literal))
    return tuple(simple), tuple(conditional)


class Disjuncts:
    """Disjunctive normal forms of ground conditions over a unit's objects; ``decide`` knows static ones."""

    def __init__(self, unit: lifted.Unit, decide: Decide, work: Work) -> None:
        self._unit = unit
        self._decide = decide
        self._tick = work.deadline.tick

    def of(self, formula: lifted.Formula) -> list[Clause]:
        """The disjuncts of a ground condition: none if false, an empty one if true; or TooManyCasesError."""
        self._tick()
        match formula:
            case lifted.Literal():
                truth = self._decide(formula)
                if truth is None:
                    return [frozenset((formula,))]
                return [frozenset()] if truth else []
            case lifted.And(parts):
                return self.of_all(parts)
            case lifted.Or(parts):
                return self._minimal(clause for part in parts for clause in self.of(part))
            case lifted.Quantified(universal, parameters, body):
                instances = (substitute(body, values) for values in assignments(parameters, self._unit))
                if universal:
                    return self.of_all(instances)
                return self._minimal(clause for part in instances for clause in self.of(part))

    def of_all(self, parts: Iterable[lifted.Formula]) -> list[Clause]:
        """The disjuncts of the conjunction of some ground conditions."""
        certain: set[lifted.Literal] = set()
        choices: list[list[Clause]] = []
        for part in parts:
            found = self.of(part)
            if not found:
                return []
            if len(found) == 1:
                certain |= found[0]
            else:
                choices.append(found)
        merged = [frozenset(certain)] if consistent(certain) else []
        for choice in choices:
            both = (a | b for a in merged for b in choice)
            merged = self._minimal(clause for clause in both if consistent(clause))
        return merged

    def _minimal(self, found: Iterable[Clause]) -> list[Clause]:
        """The clauses that no other one is part of, in order of first occurrence."""
        kept: list[Clause] = []
        for clause in found:
            self._tick()
            if not any(other <= clause for other in kept):
                kept = [other for other in kept if not clause <= other]
                kept.append(clause)
                if len(kept) > MAX_CASES:
                    raise TooManyCasesError
                if not clause:
                    break
        return kept


def consistent(literals: AbstractSet[lifted.Literal]) -> bool:
    """Whether no literal's negation is among the others."""
    return not any(literal.opposite in literals for literal in literals)
