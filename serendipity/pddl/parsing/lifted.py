"""Lifted tasks as checked values: what the grounder works on.

A term that starts with ``?`` is a variable, any other an object.  Conditions are in
negation normal form.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from serendipity.model import InputError
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.parsing.types import Type, Types

EQUALITY = "="

Key = tuple[str, ...]
"""A ground atom: predicate, then arguments."""


class Literal(NamedTuple):
    """An atom ``(predicate, terms...)`` or its negation."""

    key: Key
    positive: bool = True

    @property
    def opposite(self) -> "Literal":
        """Its negation."""
        return Literal(self.key, not self.positive)


class Parameter(NamedTuple):
    """A typed variable."""

    name: str
    type: Type


@dataclass(frozen=True, slots=True)
class And:
    """All of the parts hold (none: true)."""

    parts: tuple["Formula", ...] = ()


@dataclass(frozen=True, slots=True)
class Or:
    """One of the parts holds (none: false)."""

    parts: tuple["Formula", ...] = ()


@dataclass(frozen=True, slots=True)
class Quantified:
    """``forall`` or ``exists`` over the parameters."""

    universal: bool
    parameters: tuple[Parameter, ...]
    body: "Formula"


Formula = Literal | And | Or | Quantified


@dataclass(frozen=True, slots=True)
class Effect:
    """``literal`` for all values of ``parameters`` for which ``condition`` holds."""

    literal: Literal
    parameters: tuple[Parameter, ...] = ()
    condition: Formula | None = None


@dataclass(frozen=True, slots=True)
class FunctionValue:
    """The value of a function term in the initial state."""

    key: Key


@dataclass(frozen=True, slots=True)
class Operation:
    """Two values or more with one of ``+ - * /`` between them, from the left to the right."""

    operator: str
    values: tuple["Expression", ...]


Expression = Fraction | FunctionValue | Operation


@dataclass(frozen=True, slots=True)
class DurativeParts:
    """What a durative action asks for and changes beside its conditions at start and its effects at end.

    Attributes:
        least: its duration is at least each of these.
        most: and at most each of these.
        over_all: in negation normal form.
    """

    least: tuple[Expression, ...]
    most: tuple[Expression, ...]
    over_all: Formula
    at_end: Formula
    start_effects: tuple[Effect, ...]

    @property
    def fixed(self) -> bool:
        """Whether no inequality leaves a choice."""
        return self.least == self.most


@dataclass(frozen=True, slots=True)
class Schema:
    """A lifted action.

    Attributes:
        precondition: in negation normal form; of a durative action its condition at start.
        effects: on facts; of a durative action at end.
        increases: what is added to the total cost.
        agent: whether the first parameter is the agent that acts, by itself (MA-PDDL's ``:agent``).
        quantified: whether there are quantifiers in it.
        course: the rest of a durative action; else None.
    """

    name: str
    line: int
    parameters: tuple[Parameter, ...]
    precondition: Formula
    effects: tuple[Effect, ...]
    increases: tuple[Expression, ...]
    agent: bool = False
    quantified: bool = False
    course: DurativeParts | None = None

    @property
    def conditions(self) -> tuple[Formula, ...]:
        """What it asks for: at its start, while it goes on, and for its end."""
        course = self.course
        return (self.precondition,) if course is None else (self.precondition, course.over_all, course.at_end)

    @property
    def all_effects(self) -> tuple[Effect, ...]:
        """Effects at its start and at its end."""
        return self.effects if self.course is None else (*self.course.start_effects, *self.effects)


class TimedLiteral(NamedTuple):
    """A literal that becomes true at a time, whatever anybody does (PDDL 2.2)."""

    time: Fraction
    literal: Literal
    line: int


@dataclass(frozen=True, slots=True)
class Domain:
    """A checked domain file.

    ``predicates`` and ``functions`` map a name to the types of its parameters; ``factored`` says
    whether ``:private`` in the files of this domain names no agent (MA-PDDL); ``empty_lists`` are
    the lines where a type stands behind no constant.
    """

    name: str
    types: Types
    constants: dict[str, Type]
    predicates: dict[str, tuple[Type, ...]]
    functions: dict[str, tuple[Type, ...]]
    schemas: tuple[Schema, ...]
    factored: bool = False
    empty_lists: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Problem:
    """A checked problem file, with the objects of its domain among its own.

    Attributes:
        init: the atoms that are true, in the order of the file, each once.
        denied: the atoms that it says are false, with their lines.
        goal: in negation normal form; an empty ``And`` where there is none.
        metric: whether it asks to minimise the total cost.
        empty_lists: the lines where a type stands behind no object.
        timed: the literals that become true later.
        total_time: whether it asks to minimise the total time.
    """

    name: str
    domain_name: str | None
    objects: dict[str, Type]
    init: dict[Key, None]
    denied: dict[Key, int]
    values: dict[Key, Fraction]
    goal: Formula
    goal_line: int | None
    metric: bool
    empty_lists: tuple[int, ...] = ()
    timed: tuple[TimedLiteral, ...] = ()
    total_time: bool = False


@dataclass(frozen=True)
class Unit:
    """A domain and a problem of one task: of all of it, of the team (``owner`` None), or of one agent."""

    owner: str | None
    domain_file: str
    problem_file: str
    domain: Domain
    problem: Problem

    @property
    def priced(self) -> bool:
        """Whether actions cost what they say (0 if nothing), not 1 each, or what time they take."""
        if self.problem.total_time:
            return False
        return self.problem.metric or any(schema.increases for schema in self.domain.schemas)

    @cached_property
    def _extensions(self) -> dict[Type, tuple[str, ...]]:
        return {}

    def objects_of(self, kind: Type) -> tuple[str, ...]:
        """Names of the objects of a type, sorted."""
        known = self._extensions.get(kind)
        if known is None:
            fits = self.domain.types.is_subtype
            found = sorted(name for name, own in self.problem.objects.items() if fits(own, kind))
            known = self._extensions[kind] = tuple(found)
        return known

    def place(self, schema: Schema) -> str:
        """An action for messages: the file, the line and the name."""
        return f"{self.domain_file}:{schema.line}: action {quoted(schema.name)}"

    def domain_error(self, message: str, line: int | None) -> InputError:
        """An error in the domain file."""
        return InputError(message, self.domain_file, line)

    def problem_error(self, message: str, line: int | None) -> InputError:
        """An error in the problem file."""
        return InputError(message, self.problem_file, line)
