"""A large closure in arrays: states by layers, then Dijkstra backward by buckets of one distance."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from search.engine.shortest_paths import LevelQueue
from search.modes.assistance.distances.arcs import Arc, ClosureTooLargeError
from search.modes.assistance.distances.arrays import Indices, Kinds, Places, Words, distinct, require_room
from search.packed.cost_vector import FAR, INFINITE_KEY
from search.packed.packed_task import PackedGoal
from serendipity.model.resources.deadline import Deadline

_WORD_BITS: Final = 62

_SORTING: Final = 24
"""Bytes for each element of what is concatenated, sorted and gathered, at the least."""

_AT_ONCE: Final = 1 << 18
"""States that are sorted within some 20 ms, the same ones found in several ways counted as often."""


class _Compressed:
    """Packs the bits of some fields next to each other, so that a state fits a machine word."""

    def __init__(self, fields: Sequence[int]) -> None:
        self.runs: list[tuple[int, int]] = []
        position = 0
        for mask in fields:
            shift = (mask & -mask).bit_length() - 1 - position
            if self.runs and self.runs[-1][1] == shift:
                self.runs[-1] = (self.runs[-1][0] | mask, shift)
            else:
                self.runs.append((mask, shift))
            position += mask.bit_count()
        self.bits = position

    def __call__(self, state: int) -> int:
        packed = 0
        for mask, shift in self.runs:
            packed |= (state & mask) >> shift
        return packed


class Layers:
    """Distances of everything reachable from one state.

    Args:
        goal: where the distance is 0.
        fields: masks of the fields that a state consists of, ascending.
        limit: most states.
        deadline: polled at each transition of each layer; asked for the memory of large arrays.

    Raises:
        ClosureTooLargeError: there are more, or a state or a distance does not fit a machine word.
    """

    def __init__(
        self,
        arcs: Sequence[Arc],
        goal: PackedGoal,
        fields: Sequence[int],
        start: int,
        limit: int,
        deadline: Deadline,
    ) -> None:
        self._compressed = _Compressed(fields)
        self._heaviest = max((arc.weight for arc in arcs), default=0)
        self._too_many_unless(self._compressed.bits <= _WORD_BITS)
        self._deadline = deadline
        self._limit = limit
        self._tests, self._effects = [], []
        for arc in arcs:
            deadline.tick()
            self._tests.append(self._test(arc.condition))
            self._effects.append((self._compressed(arc.keep), self._compressed(arc.put)))
        self._arc_weights = [arc.weight for arc in arcs]
        self._weights = sorted({arc.weight for arc in arcs})
        self._goal = self._test(goal)
        self._states = self._explore(np.array([self._compressed(start)], dtype=np.int64))
        self._distances = self._spread()

    def distance(self, state: int) -> int | None:
        """Distance from a state, ``INFINITE_KEY`` if there is no way, None if it is not in here."""
        packed = self._compressed(state)
        at = int(np.searchsorted(self._states, packed))
        if at == len(self._states) or int(self._states[at]) != packed:
            return None
        found = int(self._distances[at])
        return INFINITE_KEY if found >= FAR else found

    def _too_many_unless(self, fits: bool) -> None:
        if not fits:
            raise ClosureTooLargeError

    def _test(self, condition: PackedGoal) -> tuple[int, int, list[tuple[int, int]]]:
        pack = self._compressed
        need = pack(condition.need) if condition.need >= 0 else -1
        return pack(condition.need_mask), need, [(pack(m), pack(v)) for m, v in condition.forbidden]

    @staticmethod
    def _where(test: tuple[int, int, list[tuple[int, int]]], states: Words) -> Indices:
        """Where in an array of packed states a condition holds, ascending."""
        mask, need, forbidden = test
        holds = (states & mask) == need
        for field, value in forbidden:
            holds &= (states & field) != value
        return np.flatnonzero(holds)

    def _explore(self, start: Words) -> Words:
        """Every state reachable from ``start`` (of shape ``(1,)``), ascending; the goal goes nowhere."""
        known = frontier = start
        while len(frontier):
            frontier = np.delete(frontier, self._where(self._goal, frontier))
            found = [np.empty(0, dtype=np.int64)]
            size, most = 0, _AT_ONCE
            for test, (keep, put) in zip(self._tests, self._effects, strict=True):
                self._deadline.check()
                at = self._where(test, frontier)
                if len(at):
                    found.append(frontier[at] & keep | put)
                    size += len(found[-1])
                if size > most:  # or sorting them all in the end would take long
                    found = [distinct(np.concatenate(found))]
                    size = len(found[0])
                    most = max(_AT_ONCE, 2 * size)
                    self._too_many_unless(size <= self._limit)
            require_room(_SORTING * (size + len(known)), self._deadline)
            after = distinct(np.concatenate(found))
            self._deadline.check()
            frontier = after[~_contains(known, after)]
            self._too_many_unless(len(known) + len(frontier) <= self._limit)
            self._deadline.check()
            known = np.sort(np.concatenate([known, frontier]), kind="stable")
        return known

    def _spread(self) -> Words:
        """Dijkstra from the goal backward, all states of one distance at once; the distance of each state."""
        states = self._states
        pointers, sources, weight_ids = self._predecessors()
        distances = np.full(len(states), FAR, dtype=np.int64)
        goals = self._where(self._goal, states)
        distances[goals] = 0
        queue = LevelQueue([(0, goals)])
        for level, parts in queue:
            self._deadline.check()
            self._too_many_unless(level + self._heaviest < FAR)
            nodes = distinct(np.concatenate(parts))
            nodes = nodes[distances[nodes] == level]
            require_room(_SORTING * int((pointers[nodes + 1] - pointers[nodes]).sum()), self._deadline)
            edges = _slices(pointers, nodes)
            before, kinds = sources[edges], weight_ids[edges]
            for kind, weight in enumerate(self._weights):
                chosen = before[kinds == kind]
                chosen = chosen[distances[chosen] > level + weight]
                if len(chosen):
                    distances[chosen] = level + weight
                    queue.push(level + weight, chosen)
        return distances

    def _predecessors(self) -> tuple[Words, Places, Kinds]:
        """Edges sorted by target: where each target's begin, their sources, their weights' index.

        Of shapes ``(states + 1,)``, ``(edges,)`` and ``(edges,)``.
        """
        parts = list(self._edges())
        require_room(_SORTING * sum(len(target) for _, target, _ in parts), self._deadline)
        empty = np.empty(0, dtype=np.int32)
        targets = np.concatenate([empty, *(target for _, target, _ in parts)])
        sources = np.concatenate([empty, *(source for source, _, _ in parts)])
        kinds = np.concatenate(
            [np.empty(0, dtype=np.int16), *(np.full(len(s), k, dtype=np.int16) for s, _, k in parts)]
        )
        order = self._ordered(targets)
        counts = np.bincount(targets, minlength=len(self._states))
        self._deadline.check()
        pointers = np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(counts)])
        return pointers, sources[order], kinds[order]

    def _ordered(self, values: Places) -> Indices:
        """Places in order of values, none of them negative: half by half, as numpy sorts those by radix."""
        order = np.argsort(values.astype(np.uint16), kind="stable")
        self._deadline.check()
        order = order[np.argsort((values >> 16).astype(np.uint16)[order], kind="stable")]
        self._deadline.check()
        return order

    def _edges(self) -> Iterator[tuple[Places, Places, int]]:
        """For each arc the sources of its edges, their targets, its weight's index."""
        states = self._states
        kinds = {weight: kind for kind, weight in enumerate(self._weights)}
        final = np.zeros(len(states), dtype=bool)
        final[self._where(self._goal, states)] = True
        for test, (keep, put), weight in zip(self._tests, self._effects, self._arc_weights, strict=True):
            self._deadline.check()
            at = self._where(test, states)
            at = at[~final[at]]
            if len(at):
                target = np.searchsorted(states, states[at] & keep | put)
                yield at.astype(np.int32), target.astype(np.int32), kinds[weight]


def _contains(known: Words, values: Words) -> NDArray[np.bool_]:
    """Whether each of ``values`` is in ``known``, which is ascending.

    Args:
        known: of shape ``(n,)``, not empty.
        values: of shape ``(m,)``, as the answer is.
    """
    at = np.minimum(np.searchsorted(known, values), len(known) - 1)
    return np.equal(known[at], values)


def _slices(pointers: Words, nodes: Indices) -> Words:
    """The indices ``pointers[n] .. pointers[n + 1] - 1`` of all nodes, one after another.

    Args:
        pointers: of shape ``(n + 1,)``, ascending.
        nodes: of shape ``(m,)``.
    """
    begins = pointers[nodes]
    counts = pointers[nodes + 1] - begins
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    return np.repeat(begins - (ends - counts), counts) + np.arange(total)
