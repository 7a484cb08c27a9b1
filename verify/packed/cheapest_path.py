"""Cheapest paths over packed states, all states of one estimate at once (A* in layers)."""

from collections.abc import Callable, Sequence
from heapq import heappop, heappush
from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.limits import limits
from verify.packed.landmark_cuts import Cuts, LandmarkCuts
from verify.packed.layout import Words
from verify.packed.operators import Ints, OperatorTable, Test
from verify.packed.pattern import FAR
from verify.packed.state_table import Numbers, StateTable
from verify.packed.stubborn import StubbornSets

_CUT_AT_ONCE: Final = 8
"""The same where landmarks are looked for, state by state."""


class TooManyPackedStatesError(Exception):
    """More states than the caller allows."""


class SumTooLargeError(TooManyPackedStatesError):
    """What is asked may depend on sums of weights that a machine word does not hold."""


class PackedSearch:
    """A search from several states, each with what was paid on the way there.

    Args:
        table: the operators.
        goal: what ends a path.
        bound: what is left from some states, never too much; ``FAR`` where no path leads on.
        deadline: polled.
        below: paths of this weight or more are left out; with a path's last operator it fits into a word.
        most_states: to be kept at most.
        cuts: what looks for landmarks in each state before it is expanded.
        stubborn: which operators are enough there; None: all are looked at.

    Attributes:
        least: no path that is still open weighs less.
    """

    def __init__(
        self,
        table: OperatorTable,
        goal: Test,
        bound: Callable[[Words], Ints],
        deadline: Deadline,
        below: int,
        most_states: int = 50_000_000,
        cuts: Sequence[LandmarkCuts] = (),
        stubborn: StubbornSets | None = None,
    ) -> None:
        self._table = table
        self._goal = goal
        self._bound = bound
        self._deadline = deadline
        self._below = below
        self._most_states = most_states
        self._cuts = cuts
        self._at_once = limits().states_at_once
        self._stubborn = stubborn
        self._cut_before: dict[int, Cuts] = {}
        self._states = StateTable(table.layout.words, deadline)
        self._paid = np.zeros(0, np.int64)
        self._left = np.zeros(0, np.int64)
        self._parent = np.zeros(0, np.int32)
        self._by = np.zeros(0, np.int32)
        self._queue: list[int] = []
        self._open: dict[int, list[Ints]] = {}
        self.least = 0

    @property
    def states(self) -> int:
        """The number of states that were met."""
        return self._states.count

    def add(self, states: Words, paid: Ints) -> None:
        """Start from some more states.

        Args:
            states: rows.
            paid: what was paid for each so far.
        """
        none = np.full(len(states), -1, np.int32)
        for first in range(0, len(states), self._at_once):
            part = slice(first, first + self._at_once)
            self._enter(states[part], paid[part], none[part], none[part])

    def run(self) -> int | None:
        """The number of a goal state that is reached with the least weight; None: there is none below.

        Raises:
            LimitReachedError: the deadline came first.
            TooManyPackedStatesError: there were too many states.
        """
        while self._queue:
            total = self._queue[0]
            self.least = total
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
            if self._cuts:  # one after the other: those that are nearest to a goal may end it
                order = np.argsort(self._left[numbers], kind="stable")
                self._push(numbers[order[_CUT_AT_ONCE:]])
                numbers = numbers[order[:_CUT_AT_ONCE]]
            for first in range(0, len(numbers), self._at_once):
                self._expand(numbers[first : first + self._at_once])
        return None

    def paid(self, number: int) -> int:
        """What the path to a state weighs, with what was paid where it starts."""
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
        shares = None
        if self._cuts:
            numbers, shares = self._cut(numbers)
        states = self._states.rows[numbers]
        rows, chosen = self._table.applicable(states)
        if self._stubborn is not None:
            rows, chosen = self._enough(numbers, rows, chosen, self._stubborn)
        after = self._table.after(states[rows], chosen)
        paid = self._paid[numbers[rows]] + self._table.weight[chosen]
        at_least = None if shares is None else self._left[numbers[rows]] - shares[rows, chosen]
        self._enter(after, paid, numbers[rows].astype(np.int32), chosen.astype(np.int32), at_least)

    def _cut(self, numbers: Ints) -> tuple[Ints, Ints]:
        """The states that are as cheap as they seemed, with what landmarks weigh by operator.

        The others wait until their turn comes.
        """
        kept: list[int] = []
        later: list[int] = []
        shares = np.zeros((len(numbers), len(self._table.weight)), np.int64)
        for number in numbers.tolist():
            self._deadline.check()
            found = self._cut_before.pop(number, None) or self._best_cuts(number)
            bound = found.bound
            seemed = int(self._left[number])
            if bound > seemed:
                self._left[number] = bound
                if self._paid[number] + bound < self._below:
                    self._cut_before[number] = found
                    later.append(number)
            else:
                share = shares[len(kept)]
                share[found.operators] = found.shares
                np.minimum(share + (seemed - bound), self._table.weight, out=share)
                kept.append(number)
        self._push(np.array(later, np.int64))
        return np.array(kept, np.int64), shares[: len(kept)]

    def _enough(self, numbers: Ints, rows: Ints, chosen: Ints, stubborn: StubbornSets) -> tuple[Ints, Ints]:
        """Of the operators that are applicable in some states, those that are enough."""
        kept = [np.zeros((0, 2), np.int64)]
        for row in range(len(numbers)):
            self._deadline.check()
            few = stubborn(self._facts(int(numbers[row])), chosen[rows == row].tolist())
            kept.append(np.array([(row, operator) for operator in few], np.int64).reshape(-1, 2))
        pairs = np.concatenate(kept)
        return pairs[:, 0], pairs[:, 1]

    def _facts(self, number: int) -> frozenset[int]:
        return self._table.layout.facts_of(self._states.rows[number])

    def _best_cuts(self, number: int) -> Cuts:
        """Landmarks of a state: the heaviest of those that are found one way or the other."""
        facts = self._facts(number)
        best = self._cuts[0](facts)
        for cuts in self._cuts[1:]:
            if self._paid[number] + best.bound >= self._below:
                break
            found = cuts(facts)
            if found.bound > best.bound:
                best = found
        return best

    def _enter(
        self, states: Words, paid: Ints, parent: Numbers, by: Numbers, at_least: Ints | None = None
    ) -> None:
        """Keep the cheapest way to each state that may lead on, and open it where it is a better one.

        What is left from a state is at least what was left before the operator that led there, less that
        operator's share of the landmarks.
        """
        order = np.argsort(-paid, kind="stable")  # the cheapest last: it stays
        states, paid, parent, by = states[order], paid[order], parent[order], by[order]
        numbers, new = self._states.numbers(states)
        if self._states.count > self._most_states:
            raise TooManyPackedStatesError
        self._grow()
        if len(new):
            self._paid[new] = FAR
            self._left[new] = self._bound(self._states.rows[new])
        better = paid < self._paid[numbers]
        if at_least is not None:  # only where they are opened again: who waits is found by what is left
            np.maximum.at(self._left, numbers[better], at_least[order][better])
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
