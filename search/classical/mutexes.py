"""Mutexes (h2): pairs of values that are never reached together.

Source: Haslum and Geffner, Admissible heuristics for optimal planning (2000), with ``m = 2``.
"""

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

_MOST_VALUES: Final = 4_000


class _FieldChange(NamedTuple):
    """An operator: the values that it asks for and sets, also as bit sets, and those that it leaves alone."""

    needs: tuple[int, ...]
    asked: int
    sets: tuple[int, ...]
    put: int
    kept: int


class ReachablePairs:
    """Pairs of values that may be reached together.

    Args:
        packed: the packed task, from its initial state.

    Raises:
        LimitReachedError: the deadline came, or there are too many values.
    """

    def __init__(self, packed: PackedTask, deadline: Deadline) -> None:
        self._packed = packed
        values = ((field, value) for field in packed.fields for value in packed.values(field))
        self._number = {pair: number for number, pair in enumerate(values)}
        size = len(self._number)
        if size > _MOST_VALUES:
            raise LimitReachedError("too-many-values")
        deadline.require(size * size // 8)
        self._beside = [0] * size
        """Per value those that may be reached together with it, as a bit set."""
        at_first = self._numbers(packed.all_ones, packed.init)
        for number in at_first:
            self._beside[number] = _bits(at_first)
        self._reach(_bits(at_first), self._changes(deadline), deadline)

    def _numbers(self, mask: int, state: int) -> tuple[int, ...]:
        return tuple(map(self._number.__getitem__, self._packed.assigned(mask, state)))

    def _changes(self, deadline: Deadline) -> list[_FieldChange]:
        packed, kept = self._packed, dict[int, int]()
        found = []
        for op in (*packed.own, *packed.joint, *packed.others):
            deadline.tick()
            if op.keep not in kept:
                kept[op.keep] = _bits(n for (field, _), n in self._number.items() if field & op.keep)
            needs, sets = (
                self._numbers(op.need_mask, op.need),
                self._numbers(packed.all_ones & ~op.keep, op.put),
            )
            found.append(_FieldChange(needs, _bits(needs), sets, _bits(sets), kept[op.keep]))
        return found

    def _reach(self, reached: int, changes: Sequence[_FieldChange], deadline: Deadline) -> None:
        beside, is_new = self._beside, True
        while is_new:
            is_new = False
            for needs, asked, sets, put, kept in changes:
                deadline.tick()
                found = reached
                for number in needs:
                    found &= beside[number]
                if found & asked != asked:
                    continue
                found = found & kept | put
                for number in sets:
                    if new := found & ~beside[number]:
                        is_new = True
                        self._join(number, new)
                reached |= put

    def _join(self, number: int, others: int) -> None:
        """A value may be reached together with others."""
        self._beside[number] |= others
        while others:
            lowest = others & -others
            self._beside[lowest.bit_length() - 1] |= 1 << number
            others ^= lowest

    def may_share_a_state(self, first: Operator, second: Operator) -> bool:
        """Whether what two operators ask for may be true at once."""
        beside = _bits(self._numbers(second.need_mask, second.need))
        return all(
            self._beside[number] & beside == beside for number in self._numbers(first.need_mask, first.need)
        )


def _bits(numbers: Iterable[int]) -> int:
    return sum(1 << number for number in numbers)
