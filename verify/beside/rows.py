"""Rows of words with what was paid for each."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from verify.packed.layout import Words
from verify.packed.operators import Ints

Bools = NDArray[np.bool_]


class Layer(NamedTuple):
    """Different states after some epochs, each at its least cost.

    Attributes:
        rows: the states.
        paid: units so far.
        fresh: those from which what can be done next may lead to something that is not there yet.
    """

    rows: Words
    paid: Ints
    fresh: Bools

    def only(self, chosen: Bools) -> "Layer":
        """Some of its states."""
        return Layer(self.rows[chosen], self.paid[chosen], self.fresh[chosen])


def cheapest(rows: Words, paid: Ints, fresh: Bools) -> Layer:
    """Each different row once, at its least cost; of equal costs one that is not fresh, if there is one."""
    order = np.lexsort((fresh, paid, *rows.T))
    ordered = rows[order]
    first = np.ones(len(order), bool)
    first[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    kept = order[first]
    return Layer(rows[kept], paid[kept], fresh[kept])
