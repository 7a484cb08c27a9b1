"""Expected ranks of what happens for several goals, in whole numbers: sums weighted by probabilities."""

from collections.abc import Sequence
from fractions import Fraction
from math import lcm

from search.packed.cost_vector import CostLayout

Rank = tuple[int, ...]
"""Objective and cost, then window length, lateness and number of actions, weighted sums of each."""


class Expectation:
    """Expected ranks by the keys of candidates.

    Args:
        weights: probability of each candidate; they add up to 1.
        keys: layout of the candidates' keys.

    Attributes:
        shares: the weights in units of their common denominator.
    """

    def __init__(self, weights: Sequence[Fraction], keys: CostLayout) -> None:
        self._keys = keys
        self._scale = lcm(*(weight.denominator for weight in weights))
        self.shares = [int(weight * self._scale) for weight in weights]

    def rank(self, key: int) -> Rank:
        """The components of a candidate's key that decide, in their order."""
        keys = self._keys
        return (
            key >> keys.objective_shift,
            keys.scaled_cost(key),
            keys.length(key),
            keys.start_field(key),
            keys.actions(key),
        )

    def weighted(self, ranks: Sequence[Rank]) -> Rank:
        """The expectation of a rank for each candidate."""
        return tuple(
            sum(share * part for share, part in zip(self.shares, parts, strict=True))
            for parts in zip(*ranks, strict=True)
        )

    def scaled(self, cost: Fraction) -> int:
        """A candidate's cost as it stands in ranks."""
        return int(cost * self._keys.scale)

    def unscaled(self, value: int) -> Fraction:
        """The cost that a component of an expectation stands for."""
        return Fraction(value, self._scale * self._keys.scale)
