"""What no two things can be at once: pairs of values that are never reached together.

Source: Haslum and Geffner, Admissible heuristics for optimal planning (2000), with ``m = 2``.
"""

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from search.packed.operators import Operator, split
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

_MOST_VALUES: Final = 4_000


class _Change(NamedTuple):
    """An operator: what it asks for, what it sets, and which values it leaves alone."""

    needs: NDArray[np.intp]
    sets: NDArray[np.intp]
    kept: NDArray[np.bool_]


class Pairs:
    """Pairs of values that may be reached together.

    Args:
        fields: masks of the fields, with their values.
        operators: what may be done.
        state: the packed state to begin in.
        deadline: polled.

    Attributes:
        mask: all fields.

    Raises:
        LimitReachedError: the deadline came, or there are too many values.
    """

    def __init__(
        self,
        fields: Iterable[tuple[int, Sequence[int]]],
        operators: Iterable[Operator],
        state: int,
        deadline: Deadline,
    ) -> None:
        self._lowest: dict[int, int] = {}
        self._number: dict[tuple[int, int], int] = {}
        for field, values in fields:
            self._lowest[field & -field] = field
            for value in values:
                self._number[field, value] = len(self._number)
        size = len(self._number)
        if size > _MOST_VALUES:
            raise LimitReachedError("too-many-values")
        deadline.require(size * size)
        self.mask = sum(self._lowest.values())
        at_first = self._numbers(self.mask, state)
        self._together = np.zeros((size, size), dtype=np.bool_)
        self._together[np.ix_(at_first, at_first)] = True
        self._reach(self._changes(operators, deadline), deadline)

    def _numbers(self, mask: int, state: int) -> NDArray[np.intp]:
        return np.array([self._number[f, state & f] for f in split(mask, self._lowest)], dtype=np.intp)

    def _changes(self, operators: Iterable[Operator], deadline: Deadline) -> list[_Change]:
        kept: dict[int, NDArray[np.bool_]] = {}
        found = []
        for op in operators:
            deadline.tick()
            if op.keep not in kept:
                kept[op.keep] = np.array([bool(field & op.keep) for field, _ in self._number])
            needs = self._numbers(op.need_mask, op.need)
            sets = self._numbers(self.mask & ~op.keep, op.put)
            found.append(_Change(needs, sets, kept[op.keep]))
        return found

    def _reach(self, changes: Sequence[_Change], deadline: Deadline) -> None:
        together, known = self._together, -1
        while (count := int(together.sum())) != known:
            known = count
            for needs, sets, kept in changes:
                deadline.tick()
                if not together[np.ix_(needs, needs)].all():
                    continue
                beside = together[needs].all(axis=0) & kept & together.diagonal()
                together[sets] |= beside
                together[:, sets] |= beside[:, None]
                together[np.ix_(sets, sets)] = True

    def may_share_a_state(self, first: Operator, second: Operator) -> bool:
        """Whether what two operators ask for may be true at once."""
        asked = [self._numbers(op.need_mask, op.need) for op in (first, second)]
        return bool(self._together[np.ix_(asked[0], asked[1])].all())

    def may_hold(self, mask: int, state: int) -> bool:
        """Whether what some fields hold in a packed state may be true at once."""
        numbers = self._numbers(mask, state)
        return bool(self._together[np.ix_(numbers, numbers)].all())
