"""Rows of words with what was paid for each."""

from typing import Final, NamedTuple

import numpy as np

from serendipity.model import Deadline
from verify.exhaustive.team import Bools
from verify.packed.layout import Ints, Words
from verify.packed.least_paid import LeastPaid

_AT_ONCE: Final = 250_000
"""Rows that are told apart before the clock is looked at, again."""


class RowLayer(NamedTuple):
    """Different states after some epochs, each at its least cost.

    Attributes:
        fresh: those from which what can be done next may lead to something that is not there yet.
    """

    rows: Words
    paid: Ints
    fresh: Bools

    def only(self, chosen: Bools) -> "RowLayer":
        """Some of its states."""
        return RowLayer(self.rows[chosen], self.paid[chosen], self.fresh[chosen])


class Collected:
    """Different rows, each at its least cost, as more and more come.

    Args:
        most: how many there may be.
        deadline: polled; asked for memory.
    """

    def __init__(self, words: int, most: int | None, deadline: Deadline) -> None:
        self._known = LeastPaid(words, deadline, most=most)
        self._fresh = np.zeros(0, bool)

    def add(self, rows: Words, paid: Ints, fresh: Bools | bool = False) -> None:
        """More of them; where one is there at the same cost, it stays."""
        for first in range(0, len(rows), _AT_ONCE):
            some = slice(first, first + _AT_ONCE)
            chosen, better = self._known.offer(rows[some], paid[some])
            grown = np.zeros(len(self._known.paid) - len(self._fresh), bool)
            self._fresh = np.concatenate((self._fresh, grown))
            self._fresh[chosen] = fresh if isinstance(fresh, bool) else fresh[some][better]

    def layer(self) -> RowLayer:
        """All of them."""
        return RowLayer(self._known.states.copy(), self._known.paid.copy(), self._fresh.copy())
