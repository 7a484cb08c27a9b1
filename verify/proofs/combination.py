"""Weighted sums of a program's rows, in integers: machine words where they hold them, else Python's."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verify.solvers.model import Model

Whole = NDArray[Any]

_SAFE = float(1 << 61)
"""Sums below it are exact in 64 bits."""


class Combination:
    """The rows of a program as arrays, and ``objective <= limit`` beside them."""

    def __init__(self, model: Model, limit: int | None) -> None:
        rights = [right for _, right in model.heads]
        parts = (model.coefficients, rights, model.lower, model.upper, model.objective.values())
        largest = max((abs(number) for part in parts for number in part), default=0)
        self._kind: type = np.int64 if largest < _SAFE else object
        self._index = np.asarray(model.index, dtype=np.int64)
        self._coefficients = self._numbers(model.coefficients)
        starts = np.asarray([0, *model.ends], dtype=np.int64)
        self._rows = np.repeat(np.arange(len(model.ends)), starts[1:] - starts[:-1])
        self._right = self._numbers(rights)
        senses = np.asarray([sense for sense, _ in model.heads], dtype="U2")
        self._at_most, self._at_least = senses == "<=", senses == ">="
        self._lower = self._numbers(model.lower)
        self._upper = self._numbers(model.upper)
        self._objective = self._numbers([0] * len(model.upper))
        for x, weight in model.objective.items():
            self._objective[x] = weight
        self._limit = limit

    def _numbers(self, values: Sequence[int]) -> Whole:
        return np.asarray(values, dtype=self._kind)

    def whole(self, weights: Sequence[float], denominator: int) -> Whole:
        """Multipliers as numerators of a denominator, with the signs that rows allow."""
        rounded = np.rint(np.asarray(weights) * denominator)
        rounded[self._at_most & (rounded < 0)] = 0
        rounded[self._at_least & (rounded > 0)] = 0
        return self._numbers([int(weight) for weight in rounded.clip(-_SAFE, _SAFE)])

    def out_of_reach(self, weights: Whole, objective: int, bounds: Mapping[int, tuple[int, int]]) -> bool:
        """Whether no values within the bounds satisfy the weighted sum of rows and objective.

        Args:
            weights: of the rows, with the signs that they allow.
            objective: of ``objective <= limit``; 0 where there is no limit.
            bounds: of columns, where they are not the program's.
        """
        lower, upper = self._within(bounds)
        if not self._is_safe(weights, objective, lower, upper):
            return False
        sums = objective * self._objective
        np.add.at(sums, self._index, self._coefficients * weights[self._rows])
        right = int((weights * self._right).sum()) + objective * (self._limit or 0)
        return int(np.where(sums > 0, sums * lower, sums * upper).sum()) > right

    def _within(self, bounds: Mapping[int, tuple[int, int]]) -> tuple[Whole, Whole]:
        """Least and greatest values of all columns."""
        if not bounds:
            return self._lower, self._upper
        lower, upper = self._lower.copy(), self._upper.copy()
        for x, (low, high) in bounds.items():
            lower[x], upper[x] = low, high
        return lower, upper

    def single(self, bounds: Mapping[int, tuple[int, int]]) -> tuple[int, int] | None:
        """A row that no values within the bounds satisfy, with its multiplier; -1 is the limit."""
        lower, upper = self._within(bounds)
        low, high = self._coefficients * lower[self._index], self._coefficients * upper[self._index]
        least, most = self._numbers([0] * len(self._right)), self._numbers([0] * len(self._right))
        np.add.at(least, self._rows, np.minimum(low, high))
        np.add.at(most, self._rows, np.maximum(low, high))
        above = np.flatnonzero((least > self._right) & ~self._at_least)
        below = np.flatnonzero((most < self._right) & ~self._at_most)
        if len(above):
            return int(above[0]), 1
        if len(below):
            return int(below[0]), -1
        cheapest = np.where(self._objective > 0, self._objective * lower, self._objective * upper).sum()
        return (-1, 1) if self._limit is not None and int(cheapest) > self._limit else None

    def _is_safe(self, weights: Whole, objective: int, lower: Whole, upper: Whole) -> bool:
        """Whether no sum can pass 64 bits, where that counts."""
        if self._kind is object:
            return True
        largest = max(1.0, float(np.abs(lower).max(initial=0)), float(np.abs(upper).max(initial=0)))
        terms = self._coefficients.astype(float) * weights.astype(float)[self._rows]
        total = np.abs(terms).sum() + objective * np.abs(self._objective.astype(float)).sum()
        right = np.abs(weights.astype(float) * self._right).sum() + abs(objective * float(self._limit or 0))
        return bool(total * largest < _SAFE and right < _SAFE)

    def allows(self, values: Sequence[int]) -> bool:
        """Whether whole values satisfy every row and the limit."""
        chosen = self._numbers(values)
        if ((chosen < self._lower) | (chosen > self._upper)).any():
            return False
        if self._limit is not None and int((chosen * self._objective).sum()) > self._limit:
            return False
        totals = self._numbers([0] * len(self._right))
        np.add.at(totals, self._rows, self._coefficients * chosen[self._index])
        wrong = (totals > self._right) & ~self._at_least | (totals < self._right) & ~self._at_most
        return not wrong.any()
