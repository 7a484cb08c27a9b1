"""What robots leave behind for the human: differences from what is there without any robot.

A fact is as the robot left it that changed it last.  So what robots leave behind together differs from what
is there without them just where the last robot that changed a fact left it different.  Of each robot's
differences those may be missing that another one can have undone; those that remain are put together.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.beside.rows import cheapest
from verify.packed.cheapest_path import TooManyStatesError
from verify.packed.layout import Words
from verify.packed.operators import Ints

_MOST: Final = 1_000_000
_MOST_PAIRS: Final = 30_000_000
_AT_ONCE: Final = 1_000_000


def least(rows: Words, paid: Ints) -> tuple[Words, Ints]:
    """Each different row once, at its least cost."""
    found = cheapest(rows, paid, np.zeros(len(paid), bool))
    return found.rows, found.paid


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
        TooManyStatesError: there are too many.
        LimitReachedError: the deadline came first.
    """
    found, cost = least((rows ^ base) & changed, paid)
    for bit in undone:
        deadline.check()
        differs = ((found & bit) != 0).any(axis=1)
        if differs.any():
            found, cost = least(
                np.concatenate((found, found[differs] & ~bit)), np.concatenate((cost, cost[differs]))
            )
            if len(cost) > _MOST:
                raise TooManyStatesError
    return found, cost


def together(apart: Sequence[tuple[Words, Ints]], most: int, deadline: Deadline) -> tuple[Words, Ints]:
    """What several robots leave behind, for no more than ``most``.

    Raises:
        TooManyStatesError: there are too many.
        LimitReachedError: the deadline came first.
    """
    rows, paid = apart[0]
    cheap = paid <= most
    rows, paid = rows[cheap], paid[cheap]
    for others, costs in apart[1:]:
        if len(paid) * len(costs) > _MOST_PAIRS:
            raise TooManyStatesError
        pieces = [(rows[:0], paid[:0])]
        step = max(1, _AT_ONCE // max(1, len(costs)))
        for first in range(0, len(paid), step):
            deadline.check()
            both = (rows[first : first + step, None] | others[None]).reshape(-1, rows.shape[1])
            sums = (paid[first : first + step, None] + costs[None]).ravel()
            cheap = sums <= most
            pieces.append(least(both[cheap], sums[cheap]))
        rows, paid = least(np.concatenate([r for r, _ in pieces]), np.concatenate([p for _, p in pieces]))
        if len(paid) > _MOST:
            raise TooManyStatesError
    return rows, paid
