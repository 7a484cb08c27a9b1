"""Conditions and ground actions over integer fact ids."""

from collections.abc import Collection, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Final

from serendipity.model.errors import InputError, UsageError

NOOP: Final = "noop"
"""Waiting, as plans and policies call it: always possible, free, without effect.

No ground action that asks for something or changes something may have the name.
"""

State = AbstractSet[int]
"""A state is the set of the fact ids that are true in it."""


@dataclass(frozen=True, slots=True, order=True)
class Condition:
    """A conjunction of literals: ids of facts that must be true, and false."""

    positive: tuple[int, ...] = ()
    negative: tuple[int, ...] = ()

    def holds(self, state: State) -> bool:
        """Whether every literal is true in ``state``."""
        return all(f in state for f in self.positive) and not any(f in state for f in self.negative)

    def literals(self, facts: Sequence[str]) -> tuple[str, ...]:
        """The literals by the names of facts, ``!`` in front of those that must be false."""
        return (*(facts[f] for f in self.positive), *(f"!{facts[f]}" for f in self.negative))

    def open(self, state: State) -> "Condition":
        """The literals that do not hold in a state."""
        positive = tuple(fact for fact in self.positive if fact not in state)
        return Condition(positive, tuple(fact for fact in self.negative if fact in state))

    def without(self, other: "Condition") -> "Condition":
        """What is left without the literals of another, ascending."""
        positive = sorted(set(self.positive).difference(other.positive))
        return Condition(tuple(positive), tuple(sorted(set(self.negative).difference(other.negative))))

    def __bool__(self) -> bool:
        return bool(self.positive or self.negative)


@dataclass(frozen=True, slots=True)
class Disjunction:
    """A fact that is true iff one of some literals is; each is a fact, and whether it has to be true."""

    fact: int
    literals: tuple[tuple[int, bool], ...]

    def holds(self, state: State) -> bool:
        """Whether one of the literals is true in ``state``."""
        return any((fact in state) == positive for fact, positive in self.literals)


def fitted(state: frozenset[int], disjunctions: Collection[Disjunction]) -> frozenset[int]:
    """A state whose facts that stand for disjunctions say what the others make of them."""
    held = {d.fact for d in disjunctions if d.holds(state)}
    return state.difference([d.fact for d in disjunctions]) | held


@dataclass(frozen=True, slots=True, order=True)
class Timing:
    """The course of an action that takes two epochs or more (semantics 10.1).

    Started in epoch ``t`` it ends with epoch ``t + duration - 1``.

    Attributes:
        duration: whole epochs, at least 2.
        over_all: asked of the states strictly inside: after ``t`` and up to the one before its last epoch.
        at_end: asked of the state before its last epoch.
        start_add: ids of the facts that its beginning makes true, with epoch ``t``; ascending.
        start_delete: ids of those that its beginning makes false, never in ``start_add``; ascending.
    """

    duration: int
    over_all: Condition = field(default_factory=Condition)
    at_end: Condition = field(default_factory=Condition)
    start_add: tuple[int, ...] = ()
    start_delete: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        is_whole = isinstance(self.duration, int) and not isinstance(self.duration, bool)
        if not is_whole or self.duration < 2:
            got = repr(self.duration)
            raise UsageError(f"timing: expected a whole number of epochs, at least 2, got {got:.50}")
        if not frozenset(self.start_add).isdisjoint(self.start_delete):
            raise UsageError("timing: a fact is both added and deleted at the start")


@dataclass(frozen=True, slots=True)
class GroundAction:
    """One ground action (paper, section II-A: name, cost, preconditions, effects).

    Where it takes two epochs or more, ``pre`` and ``neg`` are asked at its start, and ``add`` and ``delete``
    come with its last epoch.

    Attributes:
        name: PDDL text without brackets, lower case: ``move commx room13 hall8``.
        participants: ids of the agents that take part, ascending, at least one;
            two or more make it a joint action.
        pre: ids of the facts that must be true, ascending.
        neg: ids of the facts that must be false, ascending.
        add: ids of the facts that it makes true, ascending.
        delete: ids of the facts that it makes false, ascending; never in ``add``.
        cost: undiscounted cost, at least 0.
        timing: its course, if it takes more than one epoch; else None.
    """

    name: str
    participants: tuple[int, ...]
    pre: tuple[int, ...]
    neg: tuple[int, ...]
    add: tuple[int, ...]
    delete: tuple[int, ...]
    cost: Fraction = field(default=Fraction(1))
    timing: Timing | None = None

    def __post_init__(self) -> None:
        if self.name == NOOP and (self.pre or self.neg or self.add or self.delete):
            raise InputError(f"action '{NOOP}': that name means waiting; give what does more another name")
        if not self.participants:
            raise InputError(f"action '{self.name}': expected at least one participating agent")
        if self.cost.numerator < 0:  # three times as fast as comparing rationals
            raise InputError(f"action '{self.name}': expected a cost of at least 0, got {self.cost}")
        if self.delete and not frozenset(self.add).isdisjoint(self.delete):
            raise InputError(f"action '{self.name}': a fact is both added and deleted")

    @property
    def key(self) -> tuple[str, ...]:
        """``(name, arguments...)``: the string order of canonical choices (semantics 1)."""
        return tuple(self.name.split())

    @property
    def precondition(self) -> Condition:
        """What has to hold when it begins."""
        return Condition(self.pre, self.neg)

    @property
    def duration(self) -> int:
        """Epochs that it takes."""
        return 1 if self.timing is None else self.timing.duration

    @property
    def moments(self) -> "tuple[GroundAction, ...]":
        """What takes effect of it in an epoch, as actions of one epoch: itself, or its start and its end.

        What they ask holds when they come; what holds in between is left out.
        """
        timing = self.timing
        if timing is None:
            return (self,)
        positive = sorted({*timing.over_all.positive, *timing.at_end.positive})
        negative = sorted({*timing.over_all.negative, *timing.at_end.negative})
        start = replace(self, add=timing.start_add, delete=timing.start_delete, timing=None)
        return start, replace(self, pre=tuple(positive), neg=tuple(negative), timing=None)

    @property
    def joint(self) -> bool:
        """Whether two or more agents take part."""
        return len(self.participants) > 1

    def applicable(self, state: State) -> bool:
        """Whether every precondition holds in ``state`` (eq. 4)."""
        return all(f in state for f in self.pre) and not any(f in state for f in self.neg)


def apply(state: frozenset[int], *actions: GroundAction) -> frozenset[int]:
    """The state after some actions at once: what they delete is gone, what they add is there (eq. 4)."""
    deleted = state.difference(*[action.delete for action in actions])
    return deleted.union(*[action.add for action in actions])


def conflicting(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    """Whether two different actions can't share an epoch (semantics 2, eq. 5, 6, 10).

    They can't if an agent takes part in both, if both delete a fact, or if one
    deletes what the other adds; with ``strict`` also if one deletes or negates a
    precondition of the other.
    """
    for agent in a.participants:  # loops: this is asked for millions of pairs
        if agent in b.participants:
            return True
    for fact in a.delete:
        if fact in b.delete or fact in b.add:
            return True
    for fact in b.delete:
        if fact in a.add:
            return True
    return strict and (disables(a, b) or disables(b, a))


def disables(a: GroundAction, b: GroundAction) -> bool:
    """Whether ``a`` deletes or negates a precondition of ``b``."""
    return any(f in b.pre for f in a.delete) or any(f in b.neg for f in a.add)


def in_turn(variants: Sequence[Sequence[GroundAction]]) -> tuple[list[int], list[int]]:
    """The order of an epoch's actions in which each comes before those that disable it.

    Returns:
        The indices of those that can be done one after another, in that order, and of those for which no
        order does.
    """
    ordered, left = list[int](), list(range(len(variants)))

    def undone(i: int) -> bool:
        others = (variants[j] for j in left if j != i)
        return any(disables(mine, theirs) for other in others for mine in variants[i] for theirs in other)

    while (first := next((i for i in left if not undone(i)), None)) is not None:
        left.remove(first)
        ordered.append(first)
    return ordered, left
