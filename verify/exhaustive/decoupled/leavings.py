"""Differences that robots leave behind for the human, against the world without any robot.

A fact is as the robot left it that changed it last.  So what robots leave behind together differs from what
is there without them just where the last robot that changed a fact left it different.  Of each robot's
differences those may be missing that another one can have undone; those that remain are put together.
"""

from collections.abc import Sequence
from typing import Final

from serendipity.model import Deadline
from verify.exhaustive.decoupled.rows import Collected
from verify.limits import limits
from verify.packed.cheapest_path import TooManyPackedStatesError
from verify.packed.layout import Ints, Words

_AT_ONCE: Final = 250_000


def differences(
    rows: Words, paid: Ints, base: Words, changed: Words, undone: Sequence[Words], deadline: Deadline
) -> tuple[Words, Ints]:
    """The differences that a robot leaves behind, each once at its least cost.

    Args:
        base: the state without any robot.
        changed: bits of the facts that it can change and that matter.
        undone: of each fact the bit that another robot can have undone.
    """
    found = Collected(rows.shape[1], limits().left_behind, deadline)
    found.add((rows ^ base) & changed, paid)
    for bit in undone:
        layer = found.layer()
        without = layer.only(((layer.rows & bit) != 0).any(axis=1))
        found.add(without.rows & ~bit, without.paid)
    layer = found.layer()
    return layer.rows, layer.paid


def together(apart: Sequence[tuple[Words, Ints]], most: int, deadline: Deadline) -> tuple[Words, Ints]:
    """The differences that several robots leave behind, for no more than ``most``."""
    rows, paid = apart[0]
    rows, paid = rows[paid <= most], paid[paid <= most]
    for others, costs in apart[1:]:
        if len(paid) * len(costs) > limits().left_pairs:
            raise TooManyPackedStatesError
        joined = Collected(rows.shape[1], limits().left_behind, deadline)
        step = max(1, _AT_ONCE // max(1, len(costs)))
        for first in range(0, len(paid), step):
            both = (rows[first : first + step, None] | others[None]).reshape(-1, rows.shape[1])
            sums = (paid[first : first + step, None] + costs[None]).ravel()
            joined.add(both[sums <= most], sums[sums <= most])
        rows, paid, _ = joined.layer()
    return rows, paid
