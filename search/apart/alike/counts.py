"""What a robot can have counted after so many epochs, and what that costs it at least.

A dynamic program over blocks of places and numbers of things; a *cell* is one vector of numbers, as an index
into an array with a dimension for each counter.  Numbers stop at what there is.
"""

from collections.abc import Sequence
from math import prod
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from search.short_windows.independent.alike.robot import Edge, Robot
from search.short_windows.independent.rows import Amounts
from search.short_windows.independent.timeline import TooManyStatesError
from search.packed.cost_vector import FAR
from serendipity.model.resources.deadline import Deadline

_MOST_STATES: Final = 5_000_000
"""Blocks times cells."""

_AT_ONCE: Final = 50_000

Places = NDArray[np.int64]
"""Blocks and cells as one number: block * cells + cell."""


class Counts:
    """A robot's states, epoch by epoch.

    Args:
        robot: the robot.
        most: by counter the number that is not counted beyond.
        deadline: polled; asked for memory.

    Attributes:
        shape: of arrays of cells.
        layers: per epoch what became cheaper in it, and its amounts then; the first is the start.

    Raises:
        LimitReachedError: there are too many states, or the deadline came.
    """

    def __init__(self, robot: Robot, most: Sequence[int], deadline: Deadline) -> None:
        self._deadline = deadline
        self.shape = tuple(number + 1 for number in most)
        self._cells = prod(self.shape)
        blocks = len(robot.edges)
        if blocks * self._cells > _MOST_STATES:
            raise TooManyStatesError
        deadline.require(3 * 8 * blocks * self._cells)
        self._amounts = np.full(blocks * self._cells, FAR, dtype=np.int64)
        self._amounts[0] = 0
        self.least = np.full(self._cells, FAR, dtype=np.int64)
        self.least[0] = 0
        self._edges = robot.edges
        self._strides = np.array([prod(self.shape[i + 1 :]) for i in range(len(most))], dtype=np.int64)
        self.last: tuple[Places, Amounts] = np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64)
        self._targets, self._costs, self._counts = self._tables()

    def _tables(self) -> tuple[NDArray[np.int64], Amounts, NDArray[np.int64]]:
        """By block and edge: the block that it leads to (-1: none), its cost, and which counters go up."""
        width = max(map(len, self._edges), default=0)
        targets = np.full((len(self._edges), width), -1, dtype=np.int64)
        costs, counts = np.zeros_like(targets), np.zeros_like(targets)
        self._kinds: list[tuple[int, ...]] = []
        for block, edges in enumerate(self._edges):
            for at, edge in enumerate(edges):
                if edge.counts not in self._kinds:
                    self._kinds.append(edge.counts)
                targets[block, at], costs[block, at] = edge.target, edge.amount
                counts[block, at] = self._kinds.index(edge.counts)
        return targets, costs, counts

    def grow(self) -> None:
        """One more epoch.

        Raises:
            LimitReachedError: the deadline came.
        """
        places, amounts = self.last
        fresh: list[Places] = []
        for first in range(0, len(places), _AT_ONCE):
            self._deadline.check()
            fresh += self._leave(places[first : first + _AT_ONCE], amounts[first : first + _AT_ONCE])
        changed = np.unique(np.concatenate(fresh)) if fresh else places[:0]
        found = self._amounts[changed]
        np.minimum.at(self.least, changed % self._cells, found)
        self.last = changed, found

    def _leave(self, places: Places, amounts: Amounts) -> list[Places]:
        blocks, cells = np.divmod(places, self._cells)
        after = [self.counted(cells, counts) for counts in self._kinds]
        fresh = []
        for at in range(self._targets.shape[1]):
            targets = self._targets[blocks, at]
            able = np.flatnonzero(targets >= 0)
            from_blocks = blocks[able]
            kinds = self._counts[from_blocks, at]
            into = np.empty_like(able)
            for kind, cell in enumerate(after):
                some = kinds == kind
                into[some] = cell[able[some]]
            into += targets[able] * self._cells
            paid = amounts[able] + self._costs[from_blocks, at]
            better = paid < self._amounts[into]
            into, paid = into[better], paid[better]
            np.minimum.at(self._amounts, into, paid)
            fresh.append(into)
        return fresh

    def counted(self, cells: Places, counts: tuple[int, ...]) -> Places:
        """Cells in which some counters have gone up, as far as they go."""
        for counter in counts:
            stride, size = self._strides[counter], self.shape[counter]
            cells = cells + stride * (cells // stride % size < size - 1)
        return cells

    def within(self, most: Sequence[int]) -> NDArray[Any]:
        """What so many things or more cost at least, by numbers up to some; a dimension for each counter."""
        found = self.least.reshape(self.shape).copy()
        for axis in range(found.ndim):
            found = np.flip(np.minimum.accumulate(np.flip(found, axis), axis=axis), axis)
        return found[tuple(slice(0, number + 1) for number in most)]


def run(
    robot: Robot, numbers: Sequence[int], epochs: int, amount: int, deadline: Deadline
) -> list[Edge] | None:
    """What a robot does to see to so many things, soonest first; None where it can't be had at that cost.

    Args:
        robot: the robot.
        numbers: of things by counter.
        epochs: it may take as many.
        amount: what it costs.
        deadline: polled; asked for memory.

    Raises:
        LimitReachedError: it came.
    """
    counts = Counts(robot, numbers, deadline)
    cells = prod(counts.shape)
    layers = [counts.last]
    found = _ends(counts, amount)
    while found is None and len(layers) <= epochs:
        counts.grow()
        layers.append(counts.last)
        found = _ends(counts, amount)
    if found is None:
        return None
    edges: list[Edge] = []
    for places, amounts in reversed(layers[:-1]):
        edge, place = _before(robot, counts, places, amounts, found, amount)
        edges.append(edge)
        amount -= edge.amount
        found = place
    assert found // cells == 0, "it begins at the start"
    return edges[::-1]


def _ends(counts: Counts, amount: int) -> int | None:
    """Where all has just been counted at a cost."""
    places, amounts = counts.last
    cells = prod(counts.shape)
    right = np.flatnonzero((places % cells == cells - 1) & (amounts == amount))
    return int(places[right[0]]) if len(right) else None


def _before(
    robot: Robot, counts: Counts, places: Places, amounts: Amounts, found: int, amount: int
) -> tuple[Edge, int]:
    """The last thing that the robot did, and where it did that."""
    cells = prod(counts.shape)
    block, cell = divmod(found, cells)
    for source, edges in enumerate(robot.edges):
        for edge in edges:
            if edge.target == block:
                right = (places // cells == source) & (amounts + edge.amount == amount)
                for at in np.flatnonzero(right):
                    if int(counts.counted(np.array([places[at] % cells]), edge.counts)[0]) == cell:
                        return edge, int(places[at])
    raise AssertionError("every state but the first has one before it")
