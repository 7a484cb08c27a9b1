"""Lower bounds on the weight that is left: tables of patterns that share the operators' weights.

Every operator's weight is dealt out over the patterns, none of it twice, so that the distances of all
of them add up to no more than the weight of any plan (cost partitioning).  It is dealt out twice, from
the first pattern on and from the last: the larger sum holds.
"""

from collections import Counter
from collections.abc import Sequence
from itertools import product
from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.limits import limits
from verify.packed.layout import Ints, Words
from verify.packed.operators import FAR, OperatorTable
from verify.packed.pattern import Pattern, TooManyMovesError

_A_SECOND: Final = 20_000
"""States of a pattern for each second that is left: a large table is not made when there is little time."""

_SIZES: Final = (2_000, 100_000)
"""States of a pattern at most: patterns of each of these sizes are made, at first of the small one."""

_MOVES: Final = 30
"""Moves for each of these states at most."""

_ALL_MOVES: Final = 8_000_000
"""Moves of all patterns at most."""


class PatternBounds:
    """Bounds for one goal.

    Args:
        goal: facts that have to be true.
        careful: whether they are to spare many states, so that more time for them is worth it.
    """

    def __init__(
        self,
        table: OperatorTable,
        goal: Sequence[int],
        deadline: Deadline,
        *,
        careful: bool,
    ) -> None:
        self._table = table
        self._goal = table.test(goal, ())
        self._causes = _causes(table)
        self._deadline = deadline
        seconds, part = limits().quick_seconds, limits().quick_share
        if careful:
            seconds, part = limits().careful_seconds, limits().careful_share
        left = deadline.left()
        seconds = seconds if left is None else min(seconds, left * part)
        share = deadline.within(seconds)
        largest = int(seconds / part * _A_SECOND) + 1
        sizes = [min(size, largest) for size in (_SIZES if careful else _SIZES[:1])]
        patterns = self._patterns(sizes, deadline, share)
        self._ways = [self._dealt(patterns, deadline)]
        if share.reached() is None:
            self._ways.append(self._dealt(patterns[::-1], share))
        deadline.check()

    @property
    def states(self) -> int:
        """Of all patterns together."""
        return sum(pattern.size for way in self._ways for pattern, _ in way)

    def __call__(self, states: Words) -> Ints:
        """A bound for each state; ``FAR`` where no goal can be reached."""
        found = np.zeros((len(self._ways), len(states)), np.int64)
        index: dict[int, Ints] = {}
        for total, way in zip(found, self._ways, strict=True):
            for pattern, distance in way:
                self._deadline.check()
                if id(pattern) not in index:
                    index[id(pattern)] = pattern.index(states)
                np.minimum(total + distance[index[id(pattern)]], FAR, out=total)
        best: Ints = found.max(axis=0, initial=0)
        return best

    def _patterns(self, sizes: list[int], deadline: Deadline, share: Deadline) -> list[tuple[Pattern, Ints]]:
        """Patterns with their goals: for each field of the goal what it depends on, the nearest first."""
        found: dict[tuple[int, ...], tuple[Pattern, Ints]] = {}
        moves = 0
        for most, field in product(sizes, self._goal.conditions):
            if found and (share.reached() is not None or moves > _ALL_MOVES):
                deadline.check()
                break
            fields = self._grown(field, most)
            if fields in found:
                continue
            try:
                pattern = Pattern(self._table, fields, _MOVES * most, deadline)
            except TooManyMovesError:
                continue
            found[fields] = pattern, pattern.goals(self._goal)
            moves += len(pattern.source)
        return list(found.values())

    def _grown(self, field: int, most: int) -> tuple[int, ...]:
        """Fields that a field's changes depend on, and goals that hang together with them."""
        fields, wanted = self._table.layout.fields, self._goal.conditions
        chosen, size = [field], fields[field].size
        while True:
            strength = sum((self._causes[member] for member in chosen), Counter[int]())
            ways = [f for f in strength if f not in chosen and size * fields[f].size <= most]
            if not ways:
                return tuple(sorted(chosen))
            best = max(ways, key=lambda f: (f in wanted, strength[f], -f))
            chosen.append(best)
            size *= fields[best].size

    def _dealt(self, patterns: Sequence[tuple[Pattern, Ints]], share: Deadline) -> list[tuple[Pattern, Ints]]:
        """Each pattern takes what it makes use of, and leaves the rest to those after it."""
        left = self._table.weight.copy()
        way: list[tuple[Pattern, Ints]] = []
        for pattern, goals in patterns:
            if way and share.reached() is not None:
                break  # what is not dealt out bounds nothing
            inside = pattern.classes >= 0
            weights = np.full(pattern.kinds, FAR)
            np.minimum.at(weights, pattern.classes[inside], left[inside])
            distance = pattern.distances(weights, goals)
            if distance.any():
                way.append((pattern, distance))
            used = pattern.used(distance, pattern.kinds)
            left[inside] -= np.minimum(used[pattern.classes[inside]], left[inside])
        return way


def _causes(table: OperatorTable) -> list[Counter[int]]:
    """For each field, which others operators look at or change when they change it, and how often."""
    found = [Counter[int]() for _ in table.layout.fields]
    for conditions, effects in zip(table.conditions, table.effects, strict=True):
        for field in effects:
            found[field].update({*conditions, *effects} - {field})
    return found
