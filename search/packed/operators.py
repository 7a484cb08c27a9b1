"""Packed ground actions, and what many of them have in common.

Actions of one schema ask for the same fields and set the same fields, whatever the
places and things they are about; what depends on the fields alone is told once for
all of them.

Glossary: *field* - the bits of one variable; *op* - a packed ground action; *form* -
ops of the same agents that mention the same fields in the same way.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import reduce
from operator import or_
from typing import NamedTuple

from serendipity.model.resources.deadline import Deadline


class Operator(NamedTuple):
    """A packed ground action: applicable iff ``s & need_mask == need`` and no ``s & m == v``
    of ``forbidden``; its successor is ``s & keep | put``.
    """

    need_mask: int
    need: int
    keep: int
    put: int
    forbidden: tuple[tuple[int, int], ...]
    action: int
    agents: int
    """Bit set of its participants."""
    cost: int
    """Index of its undiscounted cost in ``PackedTask.costs``."""


class Signature(NamedTuple):
    """Ops that differ in values only.

    Attributes:
        agents: bit set of the participants.
        need_mask: the fields that ``need`` is about.
        forbids: the fields that ``forbidden`` is about.
        sets: the fields that the ops set.
        cost: index of the cost.
        ops: the ops, in the order of their actions.
    """

    agents: int
    need_mask: int
    forbids: int
    sets: int
    cost: int
    ops: list[Operator]

    @property
    def mentions(self) -> int:
        """The fields that the ops ask for or set."""
        return self.need_mask | self.forbids | self.sets


def forms_of(ops: Iterable[Operator], all_ones: int, deadline: Deadline) -> tuple[Signature, ...]:
    """Ops by their forms."""
    members = defaultdict[tuple[int, int, int, int, int], list[Operator]](list)
    for op in deadline.each(ops):
        need_mask, _, keep, _, forbidden, _, agents, cost = op
        forbids = 0
        for mask, _ in forbidden:
            forbids |= mask
        members[agents, need_mask, forbids, keep, cost].append(op)
    return tuple(
        Signature(agents, need_mask, forbids, all_ones & ~keep, cost, listed)
        for (agents, need_mask, forbids, keep, cost), listed in members.items()
    )


def set_by(forms: Iterable[Signature]) -> int:
    """The fields that some ops set."""
    return union(form.sets for form in forms)


def union(masks: Iterable[int]) -> int:
    """All fields of some masks."""
    return reduce(or_, masks, 0)


def split(mask: int, by_lowest_bit: dict[int, int]) -> Iterator[int]:
    """The fields in a mask."""
    while mask:
        field = by_lowest_bit[mask & -mask]
        yield field
        mask &= ~field


def asked_by(op: Operator) -> int:
    """The fields that an op's precondition looks at."""
    asked = op.need_mask
    for field, _ in op.forbidden:
        asked |= field
    return asked


def changed(state: int, ops: Iterable[Operator]) -> int:
    """The packed state after an epoch in which ops happen together."""
    kept, put = -1, 0
    for op in ops:
        kept &= op.keep
        put |= op.put
    return state & kept | put


def applicable(op: Operator, state: int) -> bool:
    """Whether an op's precondition holds in a packed state."""
    return state & op.need_mask == op.need and all(state & m != value for m, value in op.forbidden)
