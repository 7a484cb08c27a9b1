"""Conditions under which robots may be looked at one by one."""

from collections.abc import Iterator

import numpy as np

from search.packed.operators import Operator, asked_by
from search.packed.packed_task import PackedTask
from search.short_windows.independent.rows import column
from serendipity.model.resources.deadline import Deadline


def are_apart(packed: PackedTask, deadline: Deadline, *, strict: bool) -> bool:
    """Whether every action has one participant, and robots leave the human what they need in the same epoch.

    Where a robot may take away what an action of the human's only asks for, while that is being done,
    what the human pays after a window is no bound on what they pay in it.

    Args:
        strict: strict interference, which forbids the latter.
    """
    if packed.joint or any(op.agents & op.agents - 1 for op in packed.others):
        return False
    pairs = () if strict else _in_the_way(packed, deadline)
    return not any(packed.compatible(own.action, other.action, strict=False) for own, other in pairs)


def _in_the_way(packed: PackedTask, deadline: Deadline) -> Iterator[tuple[Operator, Operator]]:
    """The human's actions with robots' ones that may happen in the same state and undo what they ask for."""
    words = max(1, -(-packed.all_ones.bit_length() // 64))
    others = packed.others
    concerned = [own for own in deadline.each(packed.own) if packed.outside & asked_by(own)]
    if not others or not concerned:
        return
    each = zip(*((op.need_mask, op.need, op.keep & packed.all_ones, op.put) for op in others), strict=True)
    need_mask, need, keep, put = (
        np.concatenate([column(mask, words) for mask in masks], axis=1) for masks in each
    )
    for own in deadline.each(concerned):
        mask, value = column(own.need_mask, words), column(own.need, words)
        disabled = (((value & keep | put) ^ value) & mask).any(axis=0)
        for field, forbidden in own.forbidden:
            sets = (~keep & column(field, words)).any(axis=0)
            disabled |= sets & (put & column(field, words) == column(forbidden, words)).all(axis=0)
        together = ~((need ^ value) & need_mask & mask).any(axis=0)
        for place in np.flatnonzero(disabled & together):
            yield own, others[place]
