"""Rows of words with what was paid for each."""

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from serendipity.model import Deadline
from verify.packed.cheapest_path import TooManyPackedStatesError
from verify.packed.layout import Words
from verify.packed.operators import Ints

Bools = NDArray[np.bool_]

_AT_ONCE: Final = 250_000
"""Rows that are told apart together, or as many as were found before."""


class RowLayer(NamedTuple):
    """Different states after some epochs, each at its least cost.

    Attributes:
        rows: the states.
        paid: units so far.
        fresh: those from which what can be done next may lead to something that is not there yet.
    """

    rows: Words
    paid: Ints
    fresh: Bools

    def only(self, chosen: Bools) -> "RowLayer":
        """Some of its states."""
        return RowLayer(self.rows[chosen], self.paid[chosen], self.fresh[chosen])


def cheapest(rows: Words, paid: Ints, fresh: Bools, deadline: Deadline) -> RowLayer:
    """Each different row once, at its least cost; of equal costs one that is not fresh, if there is one.

    Raises:
        LimitReachedError: the deadline came first.
    """
    order = _sorted((fresh, paid, *rows.T), deadline)
    ordered = rows[order]
    first = np.ones(len(order), bool)
    first[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    kept = order[first]
    return RowLayer(rows[kept], paid[kept], fresh[kept])


def _sorted(keys: Sequence[NDArray[Any]], deadline: Deadline) -> NDArray[np.int64]:
    """Places by the last key, then by the one before it, and so on; the clock is looked at after each."""
    order = keys[0].argsort(kind="stable")
    for key in keys[1:]:
        deadline.check()
        order = order[key[order].argsort(kind="stable")]
    deadline.check()
    return order


class Collected:
    """Different rows, each at its least cost, as more and more come.

    Args:
        layer: those that there are.
        most: how many there may be.
        deadline: polled; asked for memory.
    """

    def __init__(self, layer: RowLayer, most: int, deadline: Deadline) -> None:
        self._layers, self._known, self._new = [layer], len(layer.paid), 0
        self._most, self._deadline = most, deadline

    def add(self, layer: RowLayer) -> None:
        """More of them.

        Raises:
            TooManyPackedStatesError: there are too many.
            LimitReachedError: the deadline came first.
        """
        self._layers.append(layer)
        self._new += len(layer.paid)
        if self._new > max(_AT_ONCE, self._known):
            self.layer()

    def layer(self) -> RowLayer:
        """All of them.

        Raises:
            TooManyPackedStatesError: there are too many.
            LimitReachedError: the deadline came first.
        """
        self._deadline.require(4 * sum(layer.rows.nbytes + layer.paid.nbytes for layer in self._layers))
        rows, paid, fresh = (np.concatenate(part) for part in zip(*self._layers, strict=True))
        merged = cheapest(rows, paid, fresh, self._deadline)
        if len(merged.paid) > self._most:
            raise TooManyPackedStatesError
        self._layers, self._known, self._new = [merged], len(merged.paid), 0
        return merged
