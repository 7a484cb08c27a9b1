"""Exact distances around the goal: a ball in arrays that grows to whatever is asked for.

Where a table of all states is out of reach, those that are nearer than the question need
not be.  From the goal backward, everything at one distance at once; a state is a place
in an array, so that it takes two or four bytes and only where the ball has been.
Fields that change together and have few combinations in reach (who is where) share bits.
"""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import product
from math import prod
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from search.engine.shortest_paths import LevelQueue
from search.modes.assistance.distances.closure import Arc
from search.packed.cost_vector import ACTIONS_BITS, INFINITE_KEY
from search.packed.packed_task import PackedGoal
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

Places = NDArray[np.int32]
"""Indices of states in a table, an ``int32`` each; all arrays here have one axis."""

Stored = NDArray[np.unsignedinteger[Any]]
"""Distances as they are stored, a ``uint32`` or a ``uint16`` each."""

MAX_BITS: Final = 28
"""Bits of a place's number, which has to fit an ``int32``."""

_WIDE_BITS: Final = 24
"""Up to here a distance has four bytes, beyond two."""

_MOST_TOGETHER: Final = 64
"""Combinations of fields that share bits."""

_MOST_STEPS: Final = 5_000
"""Each is tried at every distance; where there are more, trying takes longer than looking them up."""

_MOST_GOALS: Final = 1_000_000

_SORTING: Final = 16
"""Bytes for each place that is concatenated and sorted, at the least."""

_LARGE: Final = 1 << 20
"""Bytes; what is smaller is noticed in time when it has been allocated."""


class _PerimeterAxis(NamedTuple):
    """Some fields: the place of each of their combinations, and the bits of these places."""

    mask: int
    at: dict[int, int]
    bits: int


class _Back(NamedTuple):
    """An action backward: which places it may have led to, how far off they came from."""

    mask: int
    want: int
    offset: int
    weight: int


class PackedPlaces:
    """Places of states in the array.

    Args:
        fields: all values of each field that a state consists of, by its mask.
        start: a state; only combinations that may come up from there have a place.
    """

    def __init__(
        self,
        arcs: Sequence[Arc],
        fields: Mapping[int, Sequence[int]],
        start: int,
        deadline: Deadline,
    ) -> None:
        self._arcs = arcs
        self._start = start
        parts: list[tuple[int, list[int]]] = []
        for group in _changed_together(arcs, fields, deadline):
            found = None if group in fields else self._in_reach(group)
            if found is None:
                parts += [(field, [*values]) for field, values in fields.items() if field & group]
            else:
                parts.append((group, found))
        # The busiest come last, in the highest bits: neighbours in the order share their actions.
        asked = Counter(arc.condition.mask for arc in arcs)
        parts.sort(key=lambda part: sum(times for mask, times in asked.items() if mask & part[0]))
        self.bits = 0
        axes = []
        for mask, combinations in parts:
            width = (len(combinations) - 1).bit_length()
            at = {value: i << self.bits for i, value in enumerate(combinations)}
            axes.append(_PerimeterAxis(mask, at, (1 << width) - 1 << self.bits))
            self.bits += width
        self.axes = axes[::-1]

    @property
    def item(self) -> int:
        """Bytes of a distance."""
        return 4 if self.bits <= _WIDE_BITS else 2

    def place(self, state: int) -> int:
        """The place of a state; -1 if it has none."""
        found = 0
        for axis in self.axes:
            at = axis.at.get(state & axis.mask)
            if at is None:
                return -1
            found |= at
        return found

    def backward(self, arc: Arc) -> Iterator[tuple[int, int, int]]:
        """Mask and bits of places that an action leads to, and the offset to where it came from."""
        mask, choices = self._choices(arc)
        for chosen in product(*choices):
            after = sum(after for _, after in chosen)
            yield mask, after, sum(before for before, _ in chosen) - after

    def steps(self, arcs: Sequence[Arc]) -> int:
        """How many steps backward have to be tried at each distance, over all values of the first axis."""
        top, total = self.axes[0], 0
        for arc in arcs:
            mask, choices = self._choices(arc)
            total += prod(map(len, choices)) * (1 if mask & top.bits else len(top.at))
        return total

    def _choices(self, arc: Arc) -> tuple[int, list[list[tuple[int, int]]]]:
        """Per axis that an action mentions, the pairs of places that it leads between; and their mask."""
        mentioned = arc.condition.mask | ~arc.keep
        axes = [axis for axis in self.axes if axis.mask & mentioned]
        choices = [list(_pairs(axis, arc.condition, arc.keep, arc.put)) for axis in axes]
        return sum(axis.bits for axis in axes), choices

    def holding(self, condition: PackedGoal) -> Places | None:
        """Places of the states in which a condition holds, each once; None where they are too many."""
        choices = [[before for before, _ in _pairs(axis, condition, -1, 0)] for axis in self.axes]
        if prod(map(len, choices)) > _MOST_GOALS:
            return None
        places = np.zeros(1, dtype=np.int32)
        for chosen in choices:
            places = (places[:, None] + np.array(chosen, dtype=np.int32)).ravel()
        return places

    def _in_reach(self, group: int) -> list[int] | None:
        """Combinations of some fields that can be reached if nothing else is asked for."""
        arcs = {
            (arc.condition.need_mask & group, arc.condition.need & group, arc.keep & group, arc.put & group)
            for arc in self._arcs
            if group & ~arc.keep
        }
        seen, pending = {self._start & group}, [self._start & group]
        while pending:
            now = pending.pop()
            for mask, need, keep, put in arcs:
                after = now & keep | put
                if now & mask == need and after not in seen:
                    seen.add(after)
                    pending.append(after)
                    if len(seen) > _MOST_TOGETHER:
                        return None
        return sorted(seen)


def _pairs(axis: _PerimeterAxis, condition: PackedGoal, keep: int, put: int) -> Iterator[tuple[int, int]]:
    """Where on one axis a condition can hold, and where an effect leads from there."""
    here = condition.within(axis.mask)
    for value, before in axis.at.items():
        after = axis.at.get((value & keep | put) & axis.mask)
        if after is not None and here.holds(value):  # else it asks for what never comes up
            yield before, after


def _changed_together(arcs: Sequence[Arc], fields: Collection[int], deadline: Deadline) -> list[int]:
    """Masks of fields, those together that are linked by arcs that change two of them."""
    groups = list(fields)
    kept = deadline.each({arc.keep for arc in arcs})
    for changed in {sum(field for field in fields if field & ~keep) for keep in kept}:
        linked = [group for group in groups if group & changed]
        if len(linked) > 1:
            groups = [group for group in groups if not group & changed]
            groups.append(sum(linked))
    return groups


class Perimeter:
    """Distances to the goal, as far as they were asked for.

    Args:
        arcs: the transitions, of weights ``major << ACTIONS_BITS | minor``, which are compared in this order.
        goals: places of distance 0, each once.
    """

    def __init__(self, places: PackedPlaces, arcs: Sequence[Arc], goals: Places, deadline: Deadline) -> None:
        self._places = places
        self._deadline = deadline
        wide = places.item == 4
        self._minor_bits, major_bits = (14, 17) if wide else (8, 8)
        heaviest = max((arc.weight >> ACTIONS_BITS for arc in arcs), default=0)
        longest = max((arc.weight % (1 << ACTIONS_BITS) for arc in arcs), default=0)
        self._most_major = (1 << major_bits) - 2 - heaviest
        self._most_minor = (1 << self._minor_bits) - 2 - longest
        # A distance is stored plus 1, so that places that nobody touches take no memory.
        self._known: Stored = np.zeros(1 << places.bits, dtype=np.uint32 if wide else np.uint16)
        self._steps = self._backward(arcs)
        self._known[goals] = 1
        self._queue = LevelQueue([(0, goals)])

    def key(self, state: int, limit: int) -> int | None:
        """Distance from a state, ``INFINITE_KEY`` if there is no way, None if it can't be told.

        At or above ``limit`` any such value.
        """
        place = self._places.place(state)
        if place < 0:
            return None
        while True:
            found = int(self._known[place])
            level = self._queue.least
            if found and (level is None or found - 1 >> self._minor_bits < level):
                major, minor = divmod(found - 1, 1 << self._minor_bits)
                return (major << ACTIONS_BITS) + minor
            if level is None:
                return INFINITE_KEY
            if level << ACTIONS_BITS >= limit:
                return level << ACTIONS_BITS
            if not self._grow(level):
                return None

    def _backward(self, arcs: Sequence[Arc]) -> list[tuple[int, list[_Back]]]:
        """Actions by the bits of the busiest axis in the places that they lead to."""
        top = self._places.axes[0]
        by_place: dict[int, list[_Back]] = {at: [] for at in top.at.values()}
        for arc in arcs:
            major, minor = divmod(arc.weight, 1 << ACTIONS_BITS)
            weight = (major << self._minor_bits) + minor
            for asked, want, offset in self._places.backward(arc):
                if offset:
                    step = _Back(asked & ~top.bits, want & ~top.bits, offset, weight)
                    for at in [want & top.bits] if asked & top.bits else by_place:
                        by_place[at].append(step)
        return sorted(by_place.items())

    def _grow(self, level: int) -> bool:
        """Go on by the major distance that is next; False where a distance does not fit any more."""
        if level > self._most_major:
            return False
        while self._queue.least == level:  # steps without a major part lead to the level itself
            _, parts = self._queue.pop()
            grown = False
            try:
                grown = self._settle(level, parts)
            finally:
                for places in () if grown else parts:  # to be gone through again, should anybody ask again
                    self._queue.push(level, places)
            if not grown:
                return False
        return True

    def _settle(self, level: int, parts: list[Places]) -> bool:
        """Go on from places of one level; False where a distance does not fit any more.

        Of the parts one is left, with what does lie on the level, each once.
        """
        known, minor_mask = self._known, (1 << self._minor_bits) - 1
        size = _SORTING * sum(map(len, parts))
        if size > _LARGE:
            self._deadline.require(size)
        places = _distinct(np.concatenate(parts))
        parts[:] = [places[(known[places] - 1 >> self._minor_bits) == level]]
        places = parts[0]
        if int((known[places] - 1 & minor_mask).max(initial=0)) > self._most_minor:
            return False
        self._deadline.check()
        self._expand(places)
        return True

    def _expand(self, places: Places) -> None:
        """Try every step backward from places, ascending, whose distances are known."""
        known = self._known
        bounds = np.searchsorted(places, [at for at, _ in self._steps] + [1 << self._places.bits])
        for (_, steps), first, last in zip(self._steps, bounds, bounds[1:], strict=False):
            if first == last:
                continue
            here = places[first:last]
            distances = known[here]
            for mask, want, offset, weight in steps:
                self._deadline.check()
                matching = np.flatnonzero((here & mask) == want)
                if not len(matching):
                    continue
                before = here[matching] + offset
                reached = distances[matching] + known.dtype.type(weight)
                there = known[before]
                better = np.flatnonzero((there == 0) | (there > reached))
                if len(better):
                    before, reached = before[better], reached[better]
                    known[before] = reached
                    self._remember(before, reached)

    def _remember(self, places: Places, distances: Stored) -> None:
        """Put places into the levels of their distances (as stored); both of shape ``(n,)``."""
        levels = distances - 1 >> self._minor_bits
        lowest, highest = int(levels.min()), int(levels.max())
        for level in range(lowest, highest + 1):
            chosen = places if lowest == highest else places[levels == level]
            if len(chosen):
                self._queue.push(level, chosen)


def _distinct(values: Places) -> Places:
    """The values in order, each once; numpy's own ``unique`` hashes, slowly on packed states."""
    values = np.sort(values)
    first = np.ones(len(values), dtype=bool)
    first[1:] = values[1:] != values[:-1]
    return values[first]


def ball_around(
    arcs: Sequence[Arc],
    goal: PackedGoal,
    fields: Mapping[int, Sequence[int]],
    start: int,
    deadline: Deadline,
) -> Perimeter | None:
    """A ball that a state can be asked of; None where it would be too large, or a step is free.

    Too large is also what memory has no room for, were all of it touched.
    """
    if not fields or not all(arc.weight for arc in arcs):
        return None  # a step that costs nothing at all may go round for ever
    places = PackedPlaces(arcs, fields, start, deadline)
    deadline.check()
    if places.bits > MAX_BITS or places.steps(arcs) > _MOST_STEPS:
        return None
    try:
        deadline.require(places.item << places.bits)
    except LimitReachedError:
        return None
    goals = places.holding(goal)
    return None if goals is None else Perimeter(places, arcs, goals, deadline)
