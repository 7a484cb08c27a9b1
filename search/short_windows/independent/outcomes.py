"""Outcomes: values that robots leave behind for the human, each on its own, and all of them together.

An outcome is told by its difference from what is there without any robot.  Where several robots set the same
field, one of them was the last: so each may do without what another could have set, and no two of them differ
in one field.
"""

from collections.abc import Collection, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from search.short_windows.independent.landmarks import Landmark, left_to_pay
from search.short_windows.independent.provision import Value
from search.short_windows.independent.rows import Amounts, Rows, agree, cheapest, codes, column, packed_state
from search.short_windows.independent.timeline import AT_ONCE, Layer, TooManyStatesError
from serendipity.model.resources.deadline import Deadline

MOST_OUTCOMES: Final = 500_000
"""Of a robot, and of all together: sorting as many takes 0.1 s, in which nobody looks at the clock."""

_MOST_PAIRS: Final = 50_000_000

Parts = NDArray[np.int32]
"""Per outcome of all robots the places of those of each of them."""


_Some = tuple[Rows, Amounts, Amounts, Parts]
"""Some outcomes of robots together: rows, amounts, nets, parts."""


class Outcomes(NamedTuple):
    """Differences in bits, each once at the least cost that robots pay for it."""

    rows: Rows
    amounts: Amounts


def outcomes(
    layer: Layer,
    base: int,
    fields: Sequence[int],
    shared: int,
    lost: Mapping[int, Collection[int]],
    deadline: Deadline,
) -> Outcomes:
    """Outcomes of one robot.

    Args:
        layer: what it can have made of the world.
        base: the packed state without any robot.
        fields: those that the robot sets and that matter to the human.
        shared: those that others set, too.
        lost: by field the values from which the human can't get to their goal.

    Raises:
        LimitReachedError: there are too many, or the deadline came.
    """
    words = layer.rows.shape[0]
    rows = (layer.rows ^ column(base, words)) & column(sum(fields), words)
    found = _least(rows, layer.amounts, deadline)
    for field in fields:
        if field & shared:
            bits = column(field, words)
            without = (found.rows & bits).any(axis=0)
            if len(found.amounts) + int(np.count_nonzero(without)) > MOST_OUTCOMES:
                raise TooManyStatesError
            rows = np.concatenate([found.rows, found.rows[:, without] & ~bits], axis=1)
            amounts = np.concatenate([found.amounts, found.amounts[without]])
            found = _least(rows, amounts, deadline)
    hopeful = np.ones(len(found.amounts), dtype=np.bool_)
    for field in fields:
        for value in lost.get(field, ()):
            if value != base & field:
                hopeful &= ~agree(found.rows, field, (base ^ value) & field)
    return Outcomes(found.rows[:, hopeful], found.amounts[hopeful])


class Together:
    """Outcomes of all robots together.

    Attributes:
        found: what they leave behind together.

    Raises:
        LimitReachedError: there are too many, or the deadline came.
    """

    def __init__(
        self,
        apart: Sequence[Outcomes],
        nets: Sequence[Amounts],
        fields: Sequence[int],
        most: int,
        most_paid: int,
        deadline: Deadline,
    ) -> None:
        self._deadline = deadline
        self._most_paid = most_paid
        self._fields = [column(field, apart[0].rows.shape[0]) for field in fields]
        best = [int(net.min(initial=0)) for net in nets]
        self.found, self._parts = apart[0], np.arange(len(apart[0].amounts), dtype=np.int32).reshape(1, -1)
        self._nets = nets[0]
        self._keep(self._nets < most - sum(best[1:]))
        for number, more in enumerate(apart[1:], 1):
            self._join(more, nets[number], most - sum(best[number + 1 :]))

    def parts(self, place: int) -> list[int]:
        """Places of each robot's own outcome, for one of all together."""
        return [int(part) for part in self._parts[:, place]]

    def _keep(self, chosen: NDArray[Any]) -> None:
        """Leave out all others."""
        found = self.found
        self.found = Outcomes(found.rows[:, chosen], found.amounts[chosen])
        self._parts, self._nets = self._parts[:, chosen], self._nets[chosen]

    def _join(self, more: Outcomes, nets: Amounts, most: int) -> None:
        """One more robot; ``most``: where the sum of nets is as much, outcomes are left out."""
        order = nets.argsort(kind="stable")
        nets, rows, paid = nets[order], more.rows[:, order], more.amounts[order]
        most_paid = self._most_paid
        known, parts, known_nets = self.found, self._parts, self._nets
        ends = np.searchsorted(nets, most - known_nets)
        if int(ends.sum()) > _MOST_PAIRS:
            raise TooManyStatesError
        mine, theirs = self._mentioned(known.rows), self._mentioned(rows)
        self._keep(np.zeros(0, dtype=np.intp))
        self._parts = np.concatenate([self._parts, self._parts[:1]])
        batch: list[_Some] = []
        size = 0
        for i in ends.nonzero()[0]:
            self._deadline.check()
            end = int(ends[i])
            fits = ~(theirs[:, :end] & mine[:, i : i + 1]).any(axis=0)
            fits &= paid[:end] < most_paid - known.amounts[i]
            chosen = np.flatnonzero(fits)
            places = order[chosen]
            some = rows[:, chosen] | known.rows[:, i : i + 1], more.amounts[places] + known.amounts[i]
            made_of = np.concatenate([np.repeat(parts[:, i : i + 1], len(chosen), axis=1), [places]])
            batch.append((*some, nets[chosen] + known_nets[i], made_of))
            size += len(chosen)
            if size > AT_ONCE:
                self._add(batch)
                batch, size = [], 0
        self._add(batch)

    def _add(self, batch: Sequence[_Some]) -> None:
        """Compare what is put together with what was found."""
        found = [(*self.found, self._nets, self._parts), *batch]
        every, paid, nets, parts = (np.concatenate(some, axis=-1) for some in zip(*found, strict=True))
        self._deadline.require(3 * every.nbytes)
        kept = cheapest(every, paid, self._deadline)
        if len(kept) > MOST_OUTCOMES:
            raise TooManyStatesError
        self.found, self._parts = Outcomes(every[:, kept], paid[kept]), parts[:, kept].astype(np.int32)
        self._nets = nets[kept]

    def _mentioned(self, rows: Rows) -> Rows:
        """The fields in which outcomes differ from what is there without any robot, whole."""
        found = np.zeros_like(rows)
        for field in self._fields:
            found |= np.where((rows & field).any(axis=0), field, np.uint64(0))
        return found


def _least(rows: Rows, amounts: Amounts, deadline: Deadline) -> Outcomes:
    kept = cheapest(rows, amounts, deadline)
    return Outcomes(rows[:, kept], amounts[kept])


def values(rows: Rows, fields: Collection[int]) -> set[Value]:
    """The values that fields have in packed states."""
    return {
        (field, int(code) << (field & -field).bit_length() - 1)
        for field in fields
        for code in np.unique(codes(rows, field))
    }


class Remaining:
    """Outcomes, until it is known what they are worth."""

    def __init__(self, found: Outcomes, base: int) -> None:
        self._rows = found.rows ^ column(base, found.rows.shape[0])
        self._amounts = found.amounts
        self._least = found.amounts
        self._places = np.arange(len(found.amounts))

    def __len__(self) -> int:
        return len(self._least)

    @property
    def least(self) -> int:
        """The amount that none of them is below; there is one."""
        return int(self._least.min())

    def learn(self, landmarks: Sequence[Landmark]) -> None:
        """Landmarks of a state: see :func:`left_to_pay`."""
        self._least = np.maximum(self._least, self._amounts + left_to_pay(landmarks, self._rows))

    def drop(self, limit: int) -> None:
        """Leave out what is not below a limit."""
        self._keep(self._least < limit)

    def _keep(self, kept: NDArray[np.bool_]) -> None:
        self._rows, self._places = self._rows[:, kept], self._places[kept]
        self._amounts, self._least = self._amounts[kept], self._least[kept]

    def take(self) -> tuple[int, int, int]:
        """One for which least is known: its place, its state, and what robots pay for it."""
        first = int(self._least.argmin())
        found = int(self._places[first]), packed_state(self._rows, first), int(self._amounts[first])
        self._keep(np.arange(len(self._least)) != first)
        return found
