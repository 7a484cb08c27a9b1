"""Why a program allows nothing at or below a limit: a tree of branches, with multipliers at its leaves.

HiGHS solves linear relaxations and says, in floating point, which multipliers close a leaf.  They are
made rational, and a leaf counts as closed only if integer arithmetic says so; else it is split further,
so no tolerance of the solver's can make a proof.  HiGHS gives no tree of its own.
"""

from collections.abc import Sequence
from fractions import Fraction
from heapq import nsmallest
from math import inf
from typing import Any, Final

from serendipity.model import Deadline
from verify.base.undecided import UndecidedError
from verify.limits import limits
from verify.proofs import checker
from verify.proofs.combination import Combination
from verify.solvers.model import Model, largest
from verify.solvers.relaxation import Relaxation, Relaxed

Node = dict[str, Any]
"""A node as proof files have it."""

Bounds = dict[int, tuple[int, int]]

_DENOMINATORS: Final = (1, 2, 6, 12, 60, 840, 10**5, 10**7)
"""Multipliers are rounded to these, the smallest first that will do."""

_WHOLE: Final = 1e-6
"""A value that is nearer to an integer is taken for it."""

_LARGEST: Final = 10**15
"""Of a program's numbers: floats, which the search for a proof goes by, tell larger ones badly apart."""

_TRIED: Final = 32
"""Columns of which both sides are looked at before one is split."""

_DEEPEST: Final = 200
"""Branches above a leaf; readers of JSON recurse."""


def refutation(model: Model, limit: int | None, deadline: Deadline) -> Node:
    """The tree of a program.

    Args:
        limit: nothing with an objective at or below this; None: nothing at all.

    Raises:
        UndecidedError: some values satisfy the rows, or nobody could tell.
    """
    most = max(_LARGEST, limits().coefficient)
    if largest(model, deadline) > most or abs(limit or 0) > checker.MOST:
        raise UndecidedError("costs need more digits than a proof is looked for with")
    return _Tree(model, limit, deadline).grow()


class _Tree:
    def __init__(self, model: Model, limit: int | None, deadline: Deadline) -> None:
        self._model = model
        self._limit = limit
        self._relaxation = Relaxation(model, deadline)
        self._combination = Combination(model, limit)

    def grow(self) -> Node:
        """Depth first: the relaxation of a child differs by one bound from its parent's."""
        root: Node = {}
        waiting: list[tuple[Node, Bounds, int]] = [(root, {}, 0)]
        while waiting:
            node, bounds, depth = waiting.pop()
            relaxed = self._relaxation.solve(bounds)
            multipliers = self._closed(relaxed, bounds)
            if multipliers is not None:
                node["multipliers"] = multipliers
                continue
            if depth == _DEEPEST:
                raise UndecidedError(f"a proof would have more than {_DEEPEST} branches above a leaf")
            x, value = self._split(relaxed, bounds)
            low, high = bounds.get(x, (self._model.lower[x], self._model.upper[x]))
            node |= {"branch": x, "value": value, "down": {}, "up": {}}
            waiting.append((node["up"], bounds | {x: (value + 1, high)}, depth + 1))
            waiting.append((node["down"], bounds | {x: (low, value)}, depth + 1))
        return root

    def _closed(self, relaxed: Relaxed, bounds: Bounds) -> list[list[Any]] | None:
        """Multipliers of a leaf, or None where neither the relaxation nor a single row closes it."""
        found = self._closed_by_duals(relaxed, bounds)
        single = self._combination.single(bounds) if found is None else None
        return found if single is None else [[single[0], f"{single[1]}/1"]]

    def _closed_by_duals(self, relaxed: Relaxed, bounds: Bounds) -> list[list[Any]] | None:
        if relaxed.values is not None:
            if self._limit is None or relaxed.objective <= self._limit:
                return None
            return self._rounded([-dual for dual in relaxed.duals], bounds, objective=1)
        largest = max(map(abs, relaxed.duals), default=0.0)
        if not largest:
            return None
        for sign in (-1, 1):
            found = self._rounded([sign * dual / largest for dual in relaxed.duals], bounds, objective=0)
            if found is not None:
                return found
        return None

    def _rounded(self, weights: Sequence[float], bounds: Bounds, *, objective: int) -> list[list[Any]] | None:
        for denominator in _DENOMINATORS:
            whole = self._combination.whole(weights, denominator)
            if self._combination.out_of_reach(whole, objective * denominator, bounds):
                listed = [[row, _text(whole[row], denominator)] for row in range(len(whole)) if whole[row]]
                return [[-1, "1/1"], *listed] if objective else listed
        return None

    def _split(self, relaxed: Relaxed, bounds: Bounds) -> tuple[int, int]:
        """The column to branch on, and the value that is between its two sides."""
        if relaxed.values is not None:
            fractional = [
                (abs(value % 1 - 0.5), not self._model.integral[x], x)
                for x, value in enumerate(relaxed.values)
                if abs(value - round(value)) > _WHOLE
            ]
            if fractional:
                return self._best_split(relaxed, bounds, [x for *_, x in nsmallest(_TRIED, fractional)])
            if self._combination.allows([round(value) for value in relaxed.values]):
                raise UndecidedError("the program has a solution that the solver did not find")
        for x, (low, high) in enumerate(zip(self._model.lower, self._model.upper, strict=True)):
            low, high = bounds.get(x, (low, high))
            if low < high:
                return x, low
        raise UndecidedError("no multipliers close a leaf of the proof")

    def _best_split(self, relaxed: Relaxed, bounds: Bounds, columns: Sequence[int]) -> tuple[int, int]:
        """The column whose worse side gains most; the first of equals, which is nearest to a half."""
        assert relaxed.values is not None
        best, chosen = (-1.0, -1.0), (columns[0], 0)
        for x in columns:
            value = int(relaxed.values[x] // 1)
            low, high = bounds.get(x, (self._model.lower[x], self._model.upper[x]))
            sides = (self._gain(relaxed, bounds | {x: side}) for side in ((low, value), (value + 1, high)))
            worse, better = sorted(sides)
            if (worse, better) > best:
                best, chosen = (worse, better), (x, value)
            if worse == inf:
                break
        return chosen

    def _gain(self, relaxed: Relaxed, bounds: Bounds) -> float:
        """By how much the objective rises within other bounds; infinite where nothing is left."""
        child = self._relaxation.solve(bounds)
        if child.values is None or (self._limit is not None and child.objective > self._limit + _WHOLE):
            return inf
        return max(0.0, round(child.objective - relaxed.objective, 6))


def _text(numerator: int, denominator: int) -> str:
    reduced = Fraction(int(numerator), denominator)
    return f"{reduced.numerator}/{reduced.denominator}"
