"""A window of one epoch, by how many things of each kind robots have seen to until then."""

from collections.abc import Collection, Sequence
from itertools import product
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from search.short_windows.independent.alike.counts import Counts, run
from search.short_windows.independent.alike.lifted import lifted
from search.short_windows.independent.alike.robot import Robot
from search.short_windows.independent.alike.tally import Tally
from search.short_windows.independent.landmarks import Landmark, Landmarks
from search.short_windows.independent.outcomes import MOST_OUTCOMES, Outcomes
from search.short_windows.independent.provision import Value
from search.short_windows.independent.remaining import Remaining, left_to_pay
from search.short_windows.independent.rows import Amounts, Rows, column
from search.short_windows.independent.timeline import TooManyStatesError
from search.short_windows.independent.window import Window
from search.call.context import SearchContext
from search.packed.cost_vector import FAR
from search.packed.operators import Operator

_MOST_BEGUN: Final = 6
"""Things that the human has begun with: each is seen to, or not."""


class _Left(NamedTuple):
    """What a counter still counts before a window.

    Attributes:
        begun: values of things of which the human's plan has spoken by then; which of them are set matters.
        other: those of all others, which are alike.
    """

    begun: list[Value]
    other: list[Value]

    @property
    def size(self) -> int:
        return len(self.begun) + len(self.other)


class Until(NamedTuple):
    """What robots come to before a window.

    Attributes:
        robots: all of them.
        counts: of each, as far as the window.
        tally: how what they do is counted.
        spoken: the counted fields of things of which the human's plan has spoken.
        epochs: of the human's plan.
        given: the values that fields can have before or after any window.
        known: landmarks of a state, if all those could be had.
    """

    robots: Sequence[Robot]
    counts: Sequence[Counts]
    tally: Tally
    spoken: Collection[int]
    epochs: int
    given: Collection[Value]
    known: Sequence[Landmark]


class AlikeWindow(Window):
    """A window that is told by numbers.

    Args:
        context: of the call.
        landmarks: of the human's own task.
        base: the packed state before it without robots.
        start: key of what comes before it, and of the window.
        until: what robots come to before it.
        limit: key from which on nothing is of interest.

    Raises:
        LimitReachedError: too many things have been begun with, or the deadline came.
    """

    def __init__(
        self, context: SearchContext, landmarks: Landmarks, base: int, start: int, until: Until, limit: int
    ) -> None:
        super().__init__(context, landmarks, base, start)
        self._given = until.given
        self._robots = until.robots
        self._counters = until.tally.counters
        self._epochs = until.epochs
        self._left = [self._left_of(counter.values, until.spoken) for counter in self._counters]
        if sum(len(left.begun) for left in self._left) > _MOST_BEGUN:
            raise TooManyStatesError
        numbers = [left.size for left in self._left]
        self._apart = [counts.within(numbers) for counts in until.counts]
        self._join(until.known, limit)

    def _left_of(self, values: Sequence[Value], spoken: Collection[int]) -> _Left:
        left = [value for value in values if self._base & value[0] != value[1]]
        begun = [value for value in left if value[0] in spoken]
        return _Left(begun, [value for value in left if value not in begun])

    # -- what they come to

    def _join(self, known: Sequence[Landmark], limit: int) -> None:
        """Put together what each robot can do, and what of that may be worth it."""
        base = {(field, self._base & field) for field in self._context.packed.fields}
        finite = [landmark for landmark in known if landmark.cost < FAR and base.isdisjoint(landmark.void)]
        # What costs as much, less what it saves at most, is not worth it: the human pays the rest of this.
        most = self._most(limit) - sum(landmark.cost for landmark in finite)
        worth = self._worth(finite)
        self._stages = [self._apart[0]]
        for number, apart in enumerate(self._apart[1:], 1):
            later = sum(int((each - worth).min()) for each in self._apart[number + 1 :])
            self._stages.append(self._both(self._stages[-1], apart, worth, most - later))
        paid = self._stages[-1]
        found = self._outcomes(paid.reshape(-1), np.flatnonzero((paid - worth < most) & (paid < FAR)))
        chosen = found.amounts + left_to_pay(known, found.rows) < self._most(limit)
        self._cells, self._set = found.cells[chosen], found.set[chosen]
        rows = found.rows[:, chosen]
        self._remaining = Remaining(
            Outcomes(rows ^ column(self._base, len(rows)), found.amounts[chosen]), self._base
        )
        self._remaining.learn(known)

    def _worth(self, landmarks: Sequence[Landmark]) -> Amounts:
        """What the human saves at most, by numbers of things."""
        saved = [
            max(
                (sum(mark.cost for mark in landmarks if value in mark.void) for value in counter.values),
                default=0,
            )
            for counter in self._counters
        ]
        found = np.zeros(1, dtype=np.int64)
        if sum(each * size for each, size in zip(saved, self._apart[0].shape, strict=True)) >= FAR:
            raise TooManyStatesError
        for each, size in zip(saved, self._apart[0].shape, strict=True):
            found = np.add.outer(found, each * np.arange(size, dtype=np.int64))
        return found.reshape(self._apart[0].shape)

    def _both(self, one: Amounts, other: Amounts, worth: Amounts, most: int) -> Amounts:
        """What it costs together, by numbers; what is not worth it may be left out.

        Args:
            one: what some robots cost.
            other: what another one costs.
            worth: what the human saves at most.
            most: where both cost as much, less that, it is not worth it.
        """
        nets = [amounts - worth for amounts in (one, other)]
        hopeful = [
            np.argwhere(net < most - int(rest.min())) for net, rest in zip(nets, nets[::-1], strict=True)
        ]
        if len(hopeful[0]) > len(hopeful[1]):
            one, other, hopeful = other, one, hopeful[::-1]
        found = np.full(one.shape, FAR, dtype=np.int64)
        for at in hopeful[0]:
            self._context.deadline.check()
            rest = found[tuple(slice(number, None) for number in at)]
            part = other[tuple(slice(0, size) for size in rest.shape)]
            np.minimum(rest, part + one[tuple(at)], out=rest)
        return found

    def _outcomes(self, amounts: Amounts, cells: NDArray[Any]) -> "_Outcomes":
        """States that robots can leave behind, one of those that are alike.

        Args:
            amounts: what they cost by cell.
            cells: those that are asked for.
        """
        begun = [value for left in self._left for value in left.begun]
        if len(cells) << len(begun) > MOST_OUTCOMES:
            raise TooManyStatesError
        numbers = np.array(np.unravel_index(cells, self._apart[0].shape))
        tables = [self._table(left.other) for left in self._left]
        found = []
        for number, some in enumerate(product((False, True), repeat=len(begun))):
            set_ = {value for value, is_set in zip(begun, some, strict=True) if is_set}
            others = numbers - np.array([[len(set_.intersection(left.begun))] for left in self._left])
            sizes = np.array([[len(left.other)] for left in self._left])
            fits = ((others >= 0) & (others <= sizes)).all(axis=0)
            start = self._base
            for field, value in set_:
                start = start & ~field | value
            rows = np.repeat(column(start, tables[0].shape[0]), int(fits.sum()), axis=1)
            for table, places in zip(tables, others[:, fits], strict=True):
                rows ^= table[:, places]
            found.append((rows, cells[fits], np.full(rows.shape[1], number)))
        rows, chosen, set_of = (np.concatenate(part, axis=-1) for part in zip(*found, strict=True))
        return _Outcomes(rows, amounts[chosen], chosen, set_of)

    def _table(self, values: Sequence[Value]) -> Rows:
        """What differs after the first values have been set, by their number."""
        words = max(1, -(-self._context.packed.all_ones.bit_length() // 64))
        differs = [0]
        for field, value in values:
            differs.append(differs[-1] | (self._base ^ value) & field)
        return np.concatenate([column(each, words) for each in differs], axis=1)

    # -- what robots do for that

    def ways(self, place: int) -> list[list[Operator]] | None:
        """What robots do epoch by epoch for something that they leave behind; None where no way is found.

        Raises:
            LimitReachedError: the deadline came.
        """
        numbers = np.array(np.unravel_index(self._cells[place], self._apart[0].shape))
        things = self._things(int(self._set[place]), numbers)
        epochs: list[list[Operator]] = [[] for _ in range(self._epochs + 1)]
        for robot, apart, part in zip(self._robots, self._apart, self._parts(numbers), strict=True):
            own = [values[: int(number)] for values, number in zip(things, part, strict=True)]
            things = [values[int(number) :] for values, number in zip(things, part, strict=True)]
            deadline = self._context.deadline
            edges = run(robot, [int(n) for n in part], self._epochs + 1, int(apart[tuple(part)]), deadline)
            ops = (
                None
                if edges is None
                else lifted(robot, edges, [field for values in own for field, _ in values])
            )
            if ops is None:
                return None
            for epoch, op in enumerate(ops):
                epochs[epoch].append(op)
        return epochs

    def _things(self, number: int, numbers: NDArray[Any]) -> list[list[Value]]:
        """The values that are set, by counter."""
        begun = [value for left in self._left for value in left.begun]
        some = list(product((False, True), repeat=len(begun)))[number]
        set_ = {value for value, is_set in zip(begun, some, strict=True) if is_set}
        found = []
        for left, size in zip(self._left, numbers, strict=True):
            first = [value for value in left.begun if value in set_]
            found.append(first + left.other[: int(size) - len(first)])
        return found

    def _parts(self, numbers: NDArray[Any]) -> list[NDArray[Any]]:
        """How many things each robot sees to, for the cheapest of so many together."""
        found = []
        for before, after, more in reversed(
            list(zip(self._stages, self._stages[1:], self._apart[1:], strict=False))
        ):
            slices = tuple(slice(0, int(number) + 1) for number in numbers)
            both = np.flip(before[slices]) + more[slices]
            part = np.argwhere(both == after[tuple(numbers)])[0]
            found.append(part)
            numbers = numbers - part
        return [numbers, *reversed(found)]


class _Outcomes(NamedTuple):
    """States that robots leave behind.

    Attributes:
        rows: the states.
        amounts: what robots have paid.
        cells: the numbers of things that are set, as an index.
        set: which of the things that the human has begun with are among them, as a number.
    """

    rows: Rows
    amounts: Amounts
    cells: NDArray[Any]
    set: NDArray[Any]
