"""Which outcomes of robots may still be worth it: what they cost, and the human after them."""

from collections.abc import Collection, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from search.short_windows.independent.landmarks import Landmark
from search.short_windows.independent.outcomes import Outcomes
from search.short_windows.independent.provision import Value
from search.short_windows.independent.rows import Amounts, Rows, codes, column, states
from search.packed.cost_vector import FAR

_AT_ONCE: Final = 8
"""Landmarks that are looked up together, by the bits of a byte."""


def values(rows: Rows, fields: Collection[int]) -> set[Value]:
    """The values that fields have in packed states."""
    return {
        (field, int(code) << (field & -field).bit_length() - 1)
        for field in fields
        for code in np.unique(codes(rows, field))
    }


def left_to_pay(landmarks: Sequence[Landmark], rows: Rows) -> Amounts:
    """What the human pays at least from packed states, at most :data:`FAR`.

    Args:
        landmarks: of one state; the others differ from it in values only that were given then.
        rows: the states.
    """
    tables: dict[int, NDArray[np.bool_]] = {}
    for number, landmark in enumerate(landmarks):
        for field, value in landmark.void:
            table = tables.setdefault(
                field, np.zeros((len(landmarks), 1 << field.bit_count()), dtype=np.bool_)
            )
            table[number, value >> (field & -field).bit_length() - 1] = True
    at = {field: codes(rows, field) for field in tables}
    found = np.zeros(rows.shape[1], dtype=np.int64)
    for first in range(0, len(landmarks), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        void = np.zeros(rows.shape[1], dtype=np.uint8)
        for field, table in tables.items():
            if table[some].any():
                void |= np.packbits(table[some], axis=0, bitorder="little")[0][at[field]]
        found += _sums([landmark.cost for landmark in landmarks[some]])[void]
        np.minimum(found, FAR, out=found)
    return found


def _sums(costs: Sequence[int]) -> Amounts:
    """By the bits of a byte what all landmarks but those cost."""
    found = np.zeros(1, dtype=np.int64)
    for cost in (*costs, *[0] * (_AT_ONCE - len(costs))):
        found = np.concatenate([found + cost, found])
    return found


class Remaining:
    """Outcomes, until it is known what they are worth.

    Args:
        found: what robots leave behind together.
        base: the packed state without any robot.
    """

    def __init__(self, found: Outcomes, base: int) -> None:
        self._rows = found.rows ^ column(base, found.rows.shape[0])
        self._amounts = found.amounts
        self._least = found.amounts
        self._places = np.arange(len(found.amounts))

    def __len__(self) -> int:
        return len(self._least)

    @property
    def least(self) -> int:
        """The amount that none of them is below; there is one."""
        return int(self._least.min())

    def learn(self, landmarks: Sequence[Landmark]) -> None:
        """Landmarks of a state: see :func:`left_to_pay`."""
        self._least = np.maximum(self._least, self._amounts + left_to_pay(landmarks, self._rows))

    def drop(self, limit: int) -> None:
        """Leave out what is not below a limit."""
        kept = self._least < limit
        self._rows, self._places = self._rows[:, kept], self._places[kept]
        self._amounts, self._least = self._amounts[kept], self._least[kept]

    def take(self) -> tuple[int, int, int]:
        """One for which least is known: its place, its state, and what robots pay for it."""
        first = int(self._least.argmin())
        found = (
            int(self._places[first]),
            states(self._rows[:, first : first + 1])[0],
            int(self._amounts[first]),
        )
        kept = np.arange(len(self._least)) != first
        self._rows, self._places = self._rows[:, kept], self._places[kept]
        self._amounts, self._least = self._amounts[kept], self._least[kept]
        return found
