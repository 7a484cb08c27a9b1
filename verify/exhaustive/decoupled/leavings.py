"""What robots leave behind for the human: differences from what is there without any robot.

A fact is as the robot left it that changed it last.  So what robots leave behind together differs from what
is there without them just where the last robot that changed a fact left it different.  Of each robot's
differences those may be missing that another one can have undone; those that remain are put together.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.exhaustive.decoupled.rows import Collected, RowLayer, cheapest
from verify.limits import limits
from verify.packed.cheapest_path import TooManyPackedStatesError
from verify.packed.layout import Words
from verify.packed.operators import Ints

_AT_ONCE: Final = 250_000


def differences(
    rows: Words, paid: Ints, base: Words, changed: Words, undone: Sequence[Words], deadline: Deadline
) -> tuple[Words, Ints]:
    """What a robot leaves behind, each once at its least cost.

    Args:
        rows: its states.
        paid: for each of them.
        base: the state without any robot.
        changed: bits of the facts that it can change and that matter.
        undone: of each fact the bit that another robot can have undone.
        deadline: polled.

    Raises:
        TooManyPackedStatesError: there are too many.
        LimitReachedError: the deadline came first.
    """
    found = cheapest(*_layer((rows ^ base) & changed, paid), deadline)
    for bit in undone:
        deadline.check()
        without = found.only(((found.rows & bit) != 0).any(axis=1))
        if len(without.paid):
            every = Collected(found, limits().left_behind, deadline)
            every.add(_layer(without.rows & ~bit, without.paid))
            found = every.layer()
    return found.rows, found.paid


def together(apart: Sequence[tuple[Words, Ints]], most: int, deadline: Deadline) -> tuple[Words, Ints]:
    """What several robots leave behind, for no more than ``most``.

    Raises:
        TooManyPackedStatesError: there are too many.
        LimitReachedError: the deadline came first.
    """
    found, cost = apart[0]
    cheap = cost <= most
    layer = _layer(found[cheap], cost[cheap])
    for others, costs in apart[1:]:
        rows, paid = layer.rows, layer.paid
        if len(paid) * len(costs) > limits().left_pairs:
            raise TooManyPackedStatesError
        joined = Collected(_layer(rows[:0], paid[:0]), limits().left_behind, deadline)
        step = max(1, _AT_ONCE // max(1, len(costs)))
        for first in range(0, len(paid), step):
            deadline.check()
            both = (rows[first : first + step, None] | others[None]).reshape(-1, rows.shape[1])
            sums = (paid[first : first + step, None] + costs[None]).ravel()
            cheap = sums <= most
            joined.add(cheapest(*_layer(both[cheap], sums[cheap]), deadline))
        layer = joined.layer()
    return layer.rows, layer.paid


def _layer(rows: Words, paid: Ints) -> RowLayer:
    return RowLayer(rows, paid, np.zeros(len(paid), bool))
