"""Layers of packed states with what was paid, and the steps that lead from one to the next."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from serendipity.model import Deadline
from verify.exhaustive.team import NOBODY, Steps
from verify.packed.layout import Ints, Words
from verify.packed.least_paid import LeastPaid
from verify.packed.operators import OperatorTable


@dataclass(slots=True)
class EpochLayer:
    """Different states after an epoch, each at its least cost.

    Attributes:
        before: of each, the row in the layer that it comes from.
        sets: what was done in the epoch, as :class:`.team.Steps` has it.
        source: the layer that it comes from: itself by number.
    """

    states: Words
    paid: Ints
    before: Ints
    sets: Ints
    source: Ints

    def __len__(self) -> int:
        return len(self.states)

    def only(self, rows: Ints) -> "EpochLayer":
        """Some of its states."""
        return EpochLayer(
            self.states[rows], self.paid[rows], self.before[rows], self.sets[rows], self.source[rows]
        )


def first(states: Words, agents: int) -> EpochLayer:
    """The layer before the first epoch."""
    zero = np.zeros(len(states), np.int64)
    return EpochLayer(states, zero, zero - 1, np.full((len(states), agents), NOBODY), zero - 1)


def advance(
    steps: Iterable[tuple[int, EpochLayer, Iterable[Steps]]],
    hopeful: Callable[[Words, Ints], Ints],
    operators: OperatorTable,
    agents: int,
    deadline: Deadline,
) -> EpochLayer:
    """The layer after one more epoch.

    Args:
        steps: layers to come from, with their numbers and steps.
        hopeful: the rows of states, with what was paid, that are worth keeping.
    """
    known = LeastPaid(operators.layout.words, deadline, dtype=operators.weight.dtype)
    where = np.zeros((0, 2), np.int64)
    sets = np.zeros((0, agents), np.int64)
    for source, layer, pieces in steps:
        for piece in pieces:
            chosen, rows = known.offer(piece.after, layer.paid[piece.before] + piece.cost)
            grown = len(known.paid) - len(where)
            if grown:
                where = np.concatenate((where, np.zeros((grown, 2), np.int64)))
                sets = np.concatenate((sets, np.zeros((grown, agents), np.int64)))
            where[chosen, 0], where[chosen, 1] = piece.before[rows], source
            sets[chosen] = piece.sets[rows]
    layer = EpochLayer(known.states, known.paid, where[:, 0], sets, where[:, 1])
    return layer.only(hopeful(layer.states, layer.paid))
