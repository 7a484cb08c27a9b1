"""Lifted tasks as checked values: what the grounder works on.

A term that starts with ``?`` is a variable, any other an object.  Conditions are in
negation normal form.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from serendipity.model import InputError

OBJECT = "object"
EQUALITY = "="

Key = tuple[str, ...]
"""A ground atom: predicate, then arguments."""


class Literal(NamedTuple):
    """An atom ``(predicate, terms...)`` or its negation."""

    key: Key
    positive: bool = True


class Parameter(NamedTuple):
    """A typed variable."""

    name: str
    type: str


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
    """``left operator right``, the operator being one of ``+ - * /``."""

    operator: str
    left: "Expression"
    right: "Expression"


Expression = Fraction | FunctionValue | Operation


@dataclass(frozen=True, slots=True)
class Schema:
    """A lifted action.

    Attributes:
        name: lower case.
        line: where it is in the domain file.
        parameters: its declared parameters.
        precondition: in negation normal form.
        effects: on facts.
        increases: what is added to the total cost.
    """

    name: str
    line: int
    parameters: tuple[Parameter, ...]
    precondition: Formula
    effects: tuple[Effect, ...]
    increases: tuple[Expression, ...]


class Types:
    """A type hierarchy: who is a subtype of whom."""

    def __init__(self, parents: dict[str, str]) -> None:
        self._ancestors: dict[str, frozenset[str]] = {OBJECT: frozenset({OBJECT})}
        for name in parents:
            chain = [name]
            while (parent := parents.get(chain[-1], OBJECT)) not in chain:
                chain.append(parent)
            self._ancestors[name] = frozenset((*chain, OBJECT))

    def __contains__(self, name: str) -> bool:
        return name in self._ancestors

    def is_subtype(self, name: str, ancestor: str) -> bool:
        """Whether every object of type ``name`` is of type ``ancestor``."""
        return ancestor in self._ancestors[name]

    def comparable(self, a: str, b: str) -> bool:
        """Whether one of the two is a subtype of the other."""
        return b in self._ancestors[a] or a in self._ancestors[b]

    def ancestors(self, name: str) -> frozenset[str]:
        """The type, its supertypes and ``object``."""
        return self._ancestors[name]


@dataclass(frozen=True, slots=True)
class Domain:
    """A checked domain file.

    ``predicates`` and ``functions`` map a name to the types of its parameters.
    """

    name: str
    types: Types
    constants: dict[str, str]
    predicates: dict[str, tuple[str, ...]]
    functions: dict[str, tuple[str, ...]]
    schemas: tuple[Schema, ...]


@dataclass(frozen=True, slots=True)
class Problem:
    """A checked problem file, with the objects of its domain among its own.

    Attributes:
        name: of the problem.
        domain_name: the domain it says it belongs to, or None.
        objects: type of each object.
        init: the atoms that are true.
        values: values of function terms.
        goal: in negation normal form; an empty ``And`` where there is none.
        goal_line: where the goal is, or None.
        metric: whether it asks to minimise the total cost.
    """

    name: str
    domain_name: str | None
    objects: dict[str, str]
    init: frozenset[Key]
    values: dict[Key, Fraction]
    goal: Formula
    goal_line: int | None
    metric: bool


@dataclass(frozen=True, slots=True)
class Unit:
    """A domain and a problem that belong together: one task, one agent's files, or the team's.

    Attributes:
        owner: the agent, or None for a whole task and for the team.
        domain_file: for messages.
        problem_file: for messages.
        domain: the checked domain.
        problem: the checked problem.
    """

    owner: str | None
    domain_file: str
    problem_file: str
    domain: Domain
    problem: Problem

    @property
    def priced(self) -> bool:
        """Whether actions cost what they say (0 if nothing), not 1 each."""
        return self.problem.metric or any(schema.increases for schema in self.domain.schemas)

    def objects_of(self, type_name: str) -> list[str]:
        """Names of the objects of a type, sorted."""
        fits = self.domain.types.is_subtype
        return sorted(name for name, kind in self.problem.objects.items() if fits(kind, type_name))

    def domain_error(self, message: str, line: int | None) -> InputError:
        """An error in the domain file."""
        return InputError(message, self.domain_file, line)

    def problem_error(self, message: str, line: int | None) -> InputError:
        """An error in the problem file."""
        return InputError(message, self.problem_file, line)
