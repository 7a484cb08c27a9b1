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


class Together(NamedTuple):
    """Outcomes of some robots together.

    Attributes:
        nets: amounts, less what outcomes save the human by themselves.
        parts: per outcome the places of those of each robot.
    """

    rows: Rows
    amounts: Amounts
    nets: Amounts
    parts: NDArray[np.int32]

    def only(self, chosen: NDArray[Any] | slice) -> "Together":
        """Some of them."""
        return Together(self.rows[:, chosen], self.amounts[chosen], self.nets[chosen], self.parts[:, chosen])


def joined(
    apart: Sequence[Outcomes],
    nets: Sequence[Amounts],
    fields: Sequence[int],
    most: int,
    most_paid: int,
    deadline: Deadline,
) -> Together:
    """Outcomes of all robots together, but for those whose nets add up to as much as ``most``.

    Raises:
        LimitReachedError: there are too many, or the deadline came.
    """
    masks = [column(field, apart[0].rows.shape[0]) for field in fields]
    best = [int(net.min(initial=0)) for net in nets]
    numbered = (np.arange(len(net), dtype=np.int32)[None] for net in nets)
    first, *rest = map(Together, *zip(*apart, strict=True), nets, numbered)
    found = first.only(first.nets < most - sum(best[1:]))
    for number, more in enumerate(rest, 2):
        found = _both(found, more, masks, most - sum(best[number:]), most_paid, deadline)
    return found


def _both(
    known: Together, more: Together, masks: Sequence[Rows], most: int, most_paid: int, deadline: Deadline
) -> Together:
    """Outcomes with those of one more robot."""
    more = more.only(more.nets.argsort(kind="stable"))
    ends = np.searchsorted(more.nets, most - known.nets)
    if int(ends.sum()) > _MOST_PAIRS:
        raise TooManyStatesError
    mine, theirs = _mentioned(known.rows, masks), _mentioned(more.rows, masks)
    none = known.only(slice(0))
    batch = [none._replace(parts=np.concatenate([none.parts, none.parts[:1]]))]
    size = 0
    for i in ends.nonzero()[0]:
        deadline.check()
        end = int(ends[i])
        fits = ~(theirs[:, :end] & mine[:, i : i + 1]).any(axis=0)
        fits &= more.amounts[:end] < most_paid - known.amounts[i]
        one, some = known.only(slice(i, i + 1)), more.only(np.flatnonzero(fits))
        parts = np.concatenate([np.repeat(one.parts, len(some.nets), axis=1), some.parts])
        rows, amounts, nets = one.rows | some.rows, one.amounts + some.amounts, one.nets + some.nets
        batch.append(Together(rows, amounts, nets, parts))
        size += len(nets)
        if size > AT_ONCE:
            batch, size = [_cheapest(batch, deadline)], 0
    return _cheapest(batch, deadline)


def _cheapest(batch: Sequence[Together], deadline: Deadline) -> Together:
    """What is put together, each once."""
    every = Together(*(np.concatenate(some, axis=-1) for some in zip(*batch, strict=True)))
    deadline.require(3 * every.rows.nbytes)
    kept = cheapest(every.rows, every.amounts, deadline)
    if len(kept) > MOST_OUTCOMES:
        raise TooManyStatesError
    return every.only(kept)


def _mentioned(rows: Rows, masks: Sequence[Rows]) -> Rows:
    """The fields in which outcomes differ from what is there without any robot, whole."""
    found = np.zeros_like(rows)
    for mask in masks:
        found |= np.where((rows & mask).any(axis=0), mask, np.uint64(0))
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

    def __init__(self, found: Together, base: int) -> None:
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
