"""Cheapest paths over packed states, all states of one estimate at once (A* in layers)."""

from collections.abc import Callable
from heapq import heappop, heappush

import numpy as np

from serendipity.model import Deadline
from verify.limits import limits
from verify.packed.layout import Ints, Words
from verify.packed.operators import OperatorTable, Test
from verify.packed.state_table import Numbers, StateTable


class TooManyPackedStatesError(Exception):
    """More states than the caller allows."""


class SumTooLargeError(TooManyPackedStatesError):
    """Sums of weights that a machine word does not hold may decide what is asked."""


class PackedSearch:
    """A search from several states, each with what was paid on the way there.

    Args:
        bound: what is left from some states, never too much; ``FAR`` where no path leads on.
        below: paths of this weight or more are left out; with a path's last operator it fits into a word,
            unless weights are Python's integers.
    """

    def __init__(
        self,
        table: OperatorTable,
        goal: Test,
        bound: Callable[[Words], Ints],
        deadline: Deadline,
        below: int,
        most_states: int = 50_000_000,
    ) -> None:
        self._table = table
        self._goal = goal
        self._bound = bound
        self._deadline = deadline
        self._below = below
        self._most_states = most_states
        self._at_once = limits().states_at_once
        self._states = StateTable(table.layout.words, deadline)
        self._paid: Ints = np.zeros(0, table.weight.dtype)
        self._left: Ints = np.zeros(0, table.weight.dtype)
        self._parent = np.zeros(0, np.int32)
        self._by = np.zeros(0, np.int32)
        self._queue: list[int] = []
        self._open: dict[int, list[Ints]] = {}

    @property
    def states(self) -> int:
        """The number of states that were met."""
        return self._states.count

    def add(self, states: Words, paid: Ints) -> None:
        """Start from some more states."""
        none = np.full(len(states), -1, np.int32)
        for first in range(0, len(states), self._at_once):
            part = slice(first, first + self._at_once)
            self._enter(states[part], paid[part], none[part], none[part])

    def run(self) -> int | None:
        """The number of a goal state that is reached with the least weight; None: there is none below."""
        while self._queue:
            total = self._queue[0]
            batches = self._open.pop(total, None)
            if batches is None:
                heappop(self._queue)
                continue
            numbers = np.unique(np.concatenate(batches))
            numbers = numbers[self._paid[numbers] + self._left[numbers] == total]
            reached = self._goal(self._states.rows[numbers])
            if reached.any():
                self._open[total] = [numbers]
                return int(numbers[reached][0])
            for first in range(0, len(numbers), self._at_once):
                self._expand(numbers[first : first + self._at_once])
        return None

    def paid(self, number: int) -> int:
        """The weight of the path to a state, with what was paid where it starts."""
        return int(self._paid[number])

    def row(self, number: int) -> Words:
        """A state."""
        row: Words = self._states.rows[number]
        return row

    def path(self, number: int) -> tuple[int, list[int]]:
        """The state that the path to a state starts in, by number, and the operators on it."""
        operators: list[int] = []
        while self._by[number] >= 0:
            operators.append(int(self._by[number]))
            number = int(self._parent[number])
        return number, operators[::-1]

    def _expand(self, numbers: Ints) -> None:
        self._deadline.check()
        states = self._states.rows[numbers]
        rows, chosen = self._table.applicable(states)
        after = self._table.after(states[rows], chosen)
        paid = self._paid[numbers[rows]] + self._table.weight[chosen]
        self._enter(after, paid, numbers[rows].astype(np.int32), chosen.astype(np.int32))

    def _enter(self, states: Words, paid: Ints, parent: Numbers, by: Numbers) -> None:
        """Keep the cheapest way to each state that may lead on, and open it where it is a better one."""
        order = np.argsort(-paid, kind="stable")  # the cheapest last: it stays
        states, paid, parent, by = states[order], paid[order], parent[order], by[order]
        numbers, new = self._states.numbers(states)
        if self._states.count > self._most_states:
            raise TooManyPackedStatesError
        self._grow()
        if len(new):
            self._paid[new] = self._table.far
            self._left[new] = self._bound(self._states.rows[new])
        better = paid < self._paid[numbers]
        better &= paid + self._left[numbers] < self._below
        numbers, paid = numbers[better], paid[better]
        self._paid[numbers] = paid
        self._parent[numbers] = parent[better]
        self._by[numbers] = by[better]
        self._push(np.unique(numbers))

    def _push(self, numbers: Ints) -> None:
        if not len(numbers):
            return
        totals = self._paid[numbers] + self._left[numbers]
        order = np.argsort(totals, kind="stable")
        numbers, totals = numbers[order], totals[order]
        values, first = np.unique(totals, return_index=True)
        for total, part in zip(values.tolist(), np.split(numbers, first[1:]), strict=True):
            if total not in self._open:
                self._open[total] = []
                heappush(self._queue, total)
            self._open[total].append(part)

    def _grow(self) -> None:
        size = self._states.room
        if len(self._paid) < size:
            for name in ("_paid", "_left", "_parent", "_by"):
                old = getattr(self, name)
                fresh = np.zeros(size, old.dtype)
                fresh[: len(old)] = old
                setattr(self, name, fresh)
