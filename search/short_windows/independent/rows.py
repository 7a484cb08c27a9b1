"""Packed states as columns of 64-bit words, many at once."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from serendipity.model import Deadline

Rows = NDArray[np.uint64]
"""A column for each state, a row for each of its words."""

Amounts = NDArray[np.int64]
"""Per state an amount (see :mod:`search.classical.problem`)."""

Flags = NDArray[np.bool_]


def column(state: int, words: int) -> Rows:
    """A packed state as the only column."""
    return np.frombuffer(state.to_bytes(8 * words, "little"), dtype=np.uint64).reshape(words, 1)


def packed_state(rows: Rows, place: int) -> int:
    """A column as a packed state."""
    return int.from_bytes(rows[:, place].tobytes(), "little")


def agree(rows: Rows, mask: int, value: int) -> Flags:
    """Flags of the columns that have a value in the fields of a mask."""
    found = np.ones(rows.shape[1], dtype=np.bool_)
    for word, row in enumerate(rows):
        part = mask >> 64 * word & 2**64 - 1
        if part:
            found &= row & np.uint64(part) == np.uint64(value >> 64 * word & 2**64 - 1)
    return found


def codes(rows: Rows, field: int) -> NDArray[np.intp]:
    """Values of a field in packed states, moved down to the lowest bits."""
    word, bit = divmod((field & -field).bit_length() - 1, 64)
    width = field.bit_count()
    found = rows[word] >> np.uint64(bit)
    if bit + width > 64:
        found = found | rows[word + 1] << np.uint64(64 - bit)
    code: NDArray[np.intp] = (found & np.uint64((1 << width) - 1)).astype(np.intp)
    return code


def cheapest(
    rows: Rows, amounts: Amounts, deadline: Deadline, last: NDArray[Any] | None = None
) -> NDArray[np.int64]:
    """Places of a cheapest one of each different column, in the order of columns.

    Args:
        last: decides among equal amounts, the least first.
    """
    order = _sorted((amounts, *rows) if last is None else (last, amounts, *rows), deadline)
    first = np.ones(len(order), dtype=np.bool_)
    ordered = rows[:, order]
    first[1:] = (ordered[:, 1:] != ordered[:, :-1]).any(axis=0)
    return order[first]


def _sorted(keys: Sequence[NDArray[Any]], deadline: Deadline) -> NDArray[np.int64]:
    """Places by the last key, then by the one before it, and so on: ``numpy.lexsort`` that can be ended."""
    order = keys[0].argsort(kind="stable")
    for key in keys[1:]:
        deadline.check()
        order = order[key[order].argsort(kind="stable")]
    deadline.check()
    return order
