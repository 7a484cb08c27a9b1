"""Lists of different lengths as arrays, and least distances in a graph whose edges are so many."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.packed.layout import Ints

_NOTHING: Final[Ints] = np.zeros(0, np.int64)


@dataclass(frozen=True, slots=True)
class Rows:
    """Lists of different lengths, one after the other.

    Attributes:
        start: where each list starts, and where the last one ends.
        items: what is in them.
    """

    start: Ints
    items: Ints

    @classmethod
    def of(cls, lists: Sequence[Sequence[int]]) -> "Rows":
        """From lists."""
        sizes = np.fromiter(map(len, lists), np.int64, len(lists))
        items = np.fromiter(chain.from_iterable(lists), np.int64, int(sizes.sum()))
        return cls(np.concatenate(([0], np.cumsum(sizes))), items)

    @classmethod
    def by(cls, keys: Ints, count: int, items: Ints | None = None) -> "Rows":
        """From pairs of a key below ``count`` and an item; without items these are the pairs' numbers."""
        order = np.argsort(keys, kind="stable")
        start = np.concatenate(([0], np.cumsum(np.bincount(keys, minlength=count))))
        return cls(start, order if items is None else items[order])

    def sizes(self, keys: Ints) -> Ints:
        """How many items some lists have."""
        found: Ints = self.start[keys + 1] - self.start[keys]
        return found

    def keys(self) -> Ints:
        """The list that each item is in."""
        return np.repeat(np.arange(len(self.start) - 1), np.diff(self.start))

    def at(self, keys: Ints) -> Ints:
        """The items of some lists, one after the other."""
        first, sizes = self.start[keys], self.sizes(keys)
        total = int(sizes.sum())
        if not total:
            return _NOTHING
        ends = np.cumsum(sizes)
        return self.items[np.repeat(first - ends + sizes, sizes) + np.arange(total)]

    def most(self, values: Ints) -> Ints:
        """For each list the largest of its items' values; 0 for an empty one."""
        found = np.zeros(len(self.start) - 1, np.int64)
        some = np.flatnonzero(np.diff(self.start))
        if len(some):
            found[some] = np.maximum.reduceat(values[self.items], self.start[some])
        return found


def distances(
    edges: tuple[Ints, Ints, Ints], values: Ints, far: int, deadline: Deadline, limit: int | None = None
) -> Ints:
    """Least distances in a graph, from nodes that have one.

    Args:
        edges: where each starts, where it leads, and what it weighs.
        values: for each node the distance that it starts with, or ``far``.
        far: stands for no way.
        limit: a node that is further is not looked at; None: each is that there is a way to.
    """
    values, (source, target, weight) = values.copy(), edges
    leaving, most = Rows.by(source, len(values)), far - 1 if limit is None else limit
    changed = np.flatnonzero(values < far)
    while len(changed):  # Bellman and Ford, from what has changed
        deadline.check()
        out = leaving.at(changed)
        after, total = target[out], values[source[out]] + weight[out]
        better = (total <= most) & (total < values[after])
        np.minimum.at(values, after[better], total[better])
        changed = np.unique(after[better])
    return values
