"""States by number, found again by an open-addressing hash table in numpy."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from serendipity.model import Deadline
from verify.packed.layout import Words

_FIRST: Final = 1 << 12
_MIX: Final = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
_FOLD: Final = np.uint64(29)
_NONE: Final = np.int32(-1)

Numbers = NDArray[np.int32]


class StateTable:
    """Different states, numbered from 0 in the order in which they came.

    Equal rows have equal hashes, and rows are compared, so that no two states are ever taken for one.

    Args:
        deadline: asked for memory before the table grows.
    """

    def __init__(self, words: int, deadline: Deadline) -> None:
        self._deadline = deadline
        self._rows = np.zeros((_FIRST, words), np.uint64)
        self._slots = np.full(4 * _FIRST, _NONE)
        self.count = 0

    @property
    def rows(self) -> Words:
        """All states, by number."""
        return self._rows[: self.count]

    @property
    def room(self) -> int:
        """How many states fit before the table grows."""
        return len(self._rows)

    def numbers(self, states: Words) -> tuple[Numbers, Numbers]:
        """The numbers of some states, which join if they are new, and which of the numbers are new.

        Args:
            states: rows, of which some may be equal.
        """
        self._make_room(len(states))
        found = np.full(len(states), _NONE)
        slot = self._hash(states)
        last = len(self._slots) - 1
        first_new = self.count
        pending = np.arange(len(states))
        while len(pending):
            held = self._slots[slot[pending]]
            free = held == _NONE
            if free.any():
                self._claim(states, pending[free], slot)
                held = self._slots[slot[pending]]
            same = (self._rows[held] == states[pending]).all(axis=1)
            found[pending[same]] = held[same]
            pending = pending[~same]
            slot[pending] = (slot[pending] + 1) & last
        return found, np.arange(first_new, self.count, dtype=np.int32)

    def _claim(self, states: Words, rows: NDArray[np.int64], slot: NDArray[np.int64]) -> None:
        """New states take free slots: of those that want the same slot one gets it."""
        wanted = slot[rows]
        mark = np.arange(len(rows), dtype=np.int32)
        self._slots[wanted] = mark
        winners = rows[self._slots[wanted] == mark]
        after = self.count + len(winners)
        self._rows[self.count : after] = states[winners]
        self._slots[slot[winners]] = np.arange(self.count, after, dtype=np.int32)
        self.count = after

    def _hash(self, states: Words) -> NDArray[np.int64]:
        mixed = np.zeros(len(states), np.uint64)
        for word in range(states.shape[1]):
            mixed = (mixed ^ states[:, word]) * _MIX[word % len(_MIX)]
            mixed ^= mixed >> _FOLD
        return (mixed & np.uint64(len(self._slots) - 1)).astype(np.int64)

    def _make_room(self, more: int) -> None:
        size = len(self._rows)
        if self.count + more <= size:
            return
        while self.count + more > size:
            size *= 2
        self._deadline.require(float(size) * (8 * self._rows.shape[1] + 16))
        rows = np.zeros((size, self._rows.shape[1]), np.uint64)
        rows[: self.count] = self.rows
        self._rows = rows
        self._slots = np.full(4 * size, _NONE)
        slot = self._hash(self.rows)
        last = len(self._slots) - 1
        pending = np.arange(self.count)
        while len(pending):
            free = self._slots[slot[pending]] == _NONE
            self._slots[slot[pending[free]]] = pending[free]
            placed = self._slots[slot[pending]] == pending
            pending = pending[~placed]
            slot[pending] = (slot[pending] + 1) & last
