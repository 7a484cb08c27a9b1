"""What a policy is worth over scenarios: the mean, the worst, or the greatest regret (semantics 11).

The worth of one scenario is its objective, then its cost, in one int: adding worths adds both, and
comparing them compares objectives first.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import lcm
from typing import Final, NamedTuple

from search.packed.cost_vector import INFINITE_KEY, CostLayout

INFINITE_WORTH: Final = 1 << (1 << 16)
"""No plan: above every worth."""


FOLLOWING, INSIDE, OVER = range(3)
"""Phases: before a window, or without any; in it; after it."""


class Tail(NamedTuple):
    """A suffix, by the state that it begins in.

    Attributes:
        left: how many epochs are left then.
        start: ``xi1`` of the window before it.
        done: how many of its actions are done.
    """

    state: int
    left: int
    start: int
    done: int


class Member(NamedTuple):
    """A scenario that the robots hold possible, as far as it has come.

    Attributes:
        scenario: its number.
        phase: of its window.
        start: ``xi1``, where that still matters, else 0.
        tail: the suffix, once it has begun; None before.
        ahead: what it has cost more than that of its group which has cost the least; 0 for the mean.
    """

    scenario: int
    state: int
    phase: int
    start: int
    tail: Tail | None
    ahead: int


class Worths:
    """Worths of one scenario as ints.

    Args:
        keys: layout of the keys of a call.
        scale: the least common denominator of probabilities.

    Attributes:
        scale: of these.
        epoch: what an epoch of window adds.
    """

    def __init__(self, keys: CostLayout, scale: int) -> None:
        self._keys = keys
        self._bits = keys.cost_bits + 64 + scale.bit_length()
        self.scale = scale
        self.epoch = self.of_key(keys.epoch_weight)

    def of_key(self, key: int) -> int:
        """The worth of a key, or a bound on it."""
        if key >= INFINITE_KEY:
            return INFINITE_WORTH
        return (key >> self._keys.objective_shift << self._bits) + self._keys.scaled_cost(key)

    def key(self, worth: int) -> int:
        """The least key that is not worth less."""
        if worth >= INFINITE_WORTH:
            return INFINITE_KEY
        objective = worth >> self._bits
        cost = worth - (objective << self._bits)
        if cost >> self._keys.cost_bits:  # more than any cost is
            return objective + 1 << self._keys.objective_shift
        return (objective << self._keys.objective_shift) + (cost << self._keys.cost_shift)

    def above(self, worth: int) -> int:
        """A key below which every plan with a smaller objective is, and every one with the same."""
        if worth >= INFINITE_WORTH:
            return INFINITE_KEY
        return (worth >> self._bits) + 1 << self._keys.objective_shift

    def value(self, objective: Fraction, cost: Fraction) -> int:
        """The value of figures."""
        unit = self.scale * self._keys.scale
        return (int(objective * unit) << self._bits) + int(cost * unit)

    def figures(self, value: int) -> tuple[Fraction, Fraction]:
        """Objective and cost of a value, which counts parts of worths."""
        objective = value + (1 << self._bits - 1) >> self._bits  # a cost may be a difference, below 0
        cost, unit = value - (objective << self._bits), self.scale * self._keys.scale
        return Fraction(objective, unit), Fraction(cost, unit)


class Mean:
    """The mean of worths.

    Args:
        probabilities: of the scenarios; they add up to 1.

    Attributes:
        parts: of a worth that one of its values counts.
    """

    def __init__(self, probabilities: Sequence[Fraction]) -> None:
        self.parts = lcm(*(p.denominator for p in probabilities))
        self._shares = [int(p * self.parts) for p in probabilities]

    def value(self, members: Sequence[Member], rests: Sequence[int]) -> int:
        """Of a group of which each scenario has so much left to pay."""
        if max(rests) >= INFINITE_WORTH:
            return INFINITE_WORTH
        return sum(self._shares[m.scenario] * rest for m, rest in zip(members, rests, strict=True))

    def pay(self, members: Sequence[Member], paid: Sequence[int]) -> tuple[int, tuple[Member, ...]]:
        """What each of a group pays in an epoch: what that adds to its value, and the group after it."""
        return self.value(members, paid), tuple(members)

    def together(self, values: Iterable[int]) -> int:
        """Of groups that were one before."""
        return min(sum(values), INFINITE_WORTH)

    def limit(self, members: Sequence[Member], rests: Sequence[int], one: int, value: int) -> int:
        """The least rest of one with which the group, the others' being given, is worth a value."""
        if value >= INFINITE_WORTH:
            return INFINITE_WORTH
        others = self.value(members, [0 if i == one else rest for i, rest in enumerate(rests)])
        return -((others - value) // self._shares[members[one].scenario])

    def branch(self, most: int, paid: int, value: int, lower: int) -> int:
        """The least value of a branch with which a choice is worth at least so much.

        Args:
            most: so much.
            paid: before the branch begins.
            value: of the choice, where the branch is worth ``lower``.
        """
        return most - value + lower if most < INFINITE_WORTH else INFINITE_WORTH


class Greatest:
    """The greatest of worths; members begin with what they are ahead of each other, by parts of a worth."""

    def __init__(self, parts: int = 1) -> None:
        self.parts = parts

    def value(self, members: Sequence[Member], rests: Sequence[int]) -> int:
        """See :class:`Mean`."""
        if max(rests) >= INFINITE_WORTH:
            return INFINITE_WORTH
        return max(m.ahead + rest * self.parts for m, rest in zip(members, rests, strict=True))

    def pay(self, members: Sequence[Member], paid: Sequence[int]) -> tuple[int, tuple[Member, ...]]:
        """See :class:`Mean`."""
        ahead = [m.ahead + amount * self.parts for m, amount in zip(members, paid, strict=True)]
        least = min(ahead)
        return least, tuple(m._replace(ahead=a - least) for m, a in zip(members, ahead, strict=True))

    def together(self, values: Iterable[int]) -> int:
        """See :class:`Mean`."""
        return max(values)

    def limit(self, members: Sequence[Member], rests: Sequence[int], one: int, value: int) -> int:
        """See :class:`Mean`."""
        return -((members[one].ahead - value) // self.parts) if value < INFINITE_WORTH else INFINITE_WORTH

    def branch(self, most: int, paid: int, value: int, lower: int) -> int:
        """See :class:`Mean`."""
        return most - paid if most < INFINITE_WORTH else INFINITE_WORTH


Measure = Mean | Greatest
"""How worths of scenarios make one number."""


def measure_of(risk: str, probabilities: Sequence[Fraction], ahead: Iterable[Fraction] = ()) -> Measure:
    """The measure that a risk asks for; ``ahead`` are amounts that scenarios begin with, in units of cost."""
    return Mean(probabilities) if risk == "mean" else Greatest(lcm(*(one.denominator for one in ahead)))
