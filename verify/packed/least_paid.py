"""The least that was paid for each of many states, as more and more of them come."""

from math import inf
from typing import Any

import numpy as np

from serendipity.model import Deadline
from verify.packed.cheapest_path import TooManyPackedStatesError
from verify.packed.layout import Ints, Words
from verify.packed.operators import FAR
from verify.packed.state_table import StateTable


class LeastPaid:
    """Different states, numbered from 0, and the least that was paid for each.

    Args:
        dtype: of what is paid: ``object`` where that is Python's integers.
        most: how many states there may be; None: any number.

    Attributes:
        paid: by number.
    """

    def __init__(
        self, words: int, deadline: Deadline, *, dtype: Any = np.int64, most: int | None = None
    ) -> None:
        self._table, self._deadline, self._most = StateTable(words, deadline), deadline, most
        self.paid: Ints = np.zeros(0, dtype)

    @property
    def states(self) -> Words:
        """By number."""
        return self._table.rows

    def offer(self, states: Words, paid: Ints) -> tuple[Ints, Ints]:
        """More states, perhaps at lower prices.

        Args:
            states: rows, of which some may be equal.
            paid: for each of them.

        Returns:
            The numbers of those whose price was higher, or not known, and the rows that made it lower.  Where
            a number comes several times, the last one counts.

        Raises:
            TooManyPackedStatesError: there are too many states.
        """
        self._deadline.check()
        order = np.argsort(-paid, kind="stable")  # the cheapest last: it stays
        numbers = self._numbers(states[order])
        better = paid[order] < self.paid[numbers]
        chosen, rows = numbers[better], order[better]
        self.paid[chosen] = paid[rows]
        return chosen, rows

    def of(self, states: Words) -> Ints:
        """The prices of some states; more than anything costs where one is not known."""
        numbers = self._numbers(states)
        return self.paid[numbers]

    def _numbers(self, states: Words) -> Ints:
        numbers, new = self._table.numbers(states)
        if self._most is not None and self._table.count > self._most:
            raise TooManyPackedStatesError
        unknown = np.full(len(new), inf if self.paid.dtype == object else FAR, self.paid.dtype)
        self.paid = np.concatenate((self.paid, unknown))
        return numbers.astype(np.int64)
