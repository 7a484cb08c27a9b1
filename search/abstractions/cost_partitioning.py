"""Projections that add up: saturated cost partitioning (Seipp, Keller and Helmert 2020).

Each takes of every operator's weight only what its own distances need, and leaves the rest to those after
it, so the sum of all is a lower bound.  Which comes first matters: there are several orders, each best
for some state that was met, and the bound is the greatest of their sums.
"""

from collections.abc import Sequence

import numpy as np

from search.abstractions.projection import Numbers, Projection
from search.packed.cost_vector import FAR, INFINITE_KEY
from serendipity.model.resources.deadline import Deadline


class CostPartitioning:
    """A consistent lower bound on what the human pays alone from a packed state.

    Args:
        projections: of the human's own task.
        weights: of each operator, at least 0.
        samples: packed states for which orders are chosen, the first of them always.
        most_orders: how many are kept at most.
        deadline: polled while tables are made.
    """

    def __init__(
        self,
        projections: Sequence[Projection],
        weights: Numbers,
        samples: Sequence[int],
        most_orders: int,
        deadline: Deadline,
    ) -> None:
        self._projections = list(projections)
        self._weights = weights
        self._deadline = deadline
        self._orders: list[list[Numbers]] = []
        self._choose(samples, most_orders)
        self._masks = [sum(field.mask for field in each.fields) for each in self._projections]
        self._known: list[dict[int, tuple[int, ...]]] = [{} for _ in self._projections]

    def _choose(self, samples: Sequence[int], most_orders: int) -> None:
        """Keep an order where it says more of some sample than those before."""
        at = [np.array([each.number(state) for state in samples]) for each in self._projections]
        alone = [each.distances(self._weights, self._deadline) for each in self._projections]
        taken = [
            int(each.saturated(far, len(self._weights)).sum())
            for each, far in zip(self._projections, alone, strict=True)
        ]
        best = np.full(len(samples), -1, dtype=np.int64)
        for sample in range(len(samples)):
            if len(self._orders) == most_orders:
                return
            worth = [
                int(far[numbers[sample]]) / (took + 1)
                for far, numbers, took in zip(alone, at, taken, strict=True)
            ]
            tables = self._partition(sorted(range(len(worth)), key=lambda i: -worth[i]))
            said = np.zeros(len(samples), dtype=np.int64)
            for table, numbers in zip(tables, at, strict=True):
                said = np.minimum(said + table[numbers], FAR)
            if (said > best).any():
                best = np.maximum(said, best)
                self._orders.append(tables)

    def _partition(self, order: Sequence[int]) -> list[Numbers]:
        """A table for each projection, by its place."""
        left = self._weights.copy()
        tables = {}
        for place in order:
            projection = self._projections[place]
            tables[place] = projection.distances(left, self._deadline)
            left -= projection.saturated(tables[place], len(left))
        return [tables[place] for place in range(len(order))]

    def __call__(self, state: int) -> int:
        """The bound; ``INFINITE_KEY`` where a projection shows that there is no way."""
        rows = [
            known.get(state & mask) or self._look_up(place, state & mask)
            for place, (mask, known) in enumerate(zip(self._masks, self._known, strict=True))
        ]
        return min(max(map(sum, zip(*rows, strict=True))), INFINITE_KEY)

    def _look_up(self, place: int, seen: int) -> tuple[int, ...]:
        number = self._projections[place].number(seen)
        found = (int(tables[place][number]) for tables in self._orders)
        row = self._known[place][seen] = tuple(far if far < FAR else INFINITE_KEY for far in found)
        return row
