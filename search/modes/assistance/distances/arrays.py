"""Arrays of numbers of one kind, all with one axis: what tables of distances consist of."""

from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from serendipity.model.resources.deadline import Deadline

Words = NDArray[np.int64]
"""Packed states, distances or offsets, an ``int64`` each."""

Places = NDArray[np.int32]
"""Indices of states in a table, an ``int32`` each."""

Kinds = NDArray[np.int16]
"""Indices of weights among the different ones, an ``int16`` each."""

Indices = NDArray[np.intp]
"""Indices as numpy gives them, a word each."""

Stored = NDArray[np.unsignedinteger[Any]]
"""Distances as they are stored, a ``uint32`` or a ``uint16`` each."""

_LARGE: Final = 1 << 20
"""Bytes; what is smaller is noticed in time when it has been allocated."""

Number = TypeVar("Number", bound=np.signedinteger[Any])


def distinct(values: NDArray[Number]) -> NDArray[Number]:
    """The values in order, each once; numpy's own ``unique`` hashes, slowly on packed states.

    Args:
        values: of shape ``(n,)``, in any order.
    """
    values = np.sort(values)
    first = np.ones(len(values), dtype=bool)
    first[1:] = values[1:] != values[:-1]
    return values[first]


def require_room(size: int, deadline: Deadline) -> None:
    """Ask for the memory of arrays that are large; asking takes a moment.

    Raises:
        LimitReachedError: there is not that much.
    """
    if size > _LARGE:
        deadline.require(size)
