"""What was worked out, kept for later: tables for every call on a task, and caches by state."""

from collections.abc import Callable
from typing import Generic, TypeVar

from serendipity.model.resources.deadline import Deadline

T = TypeVar("T")


class KeptTable(Generic[T]):
    """A table that is built under the deadline of who asks first; where that comes, nothing is half made.

    Args:
        build: builds it; holds nothing that holds the table, as nobody collects circles in a call.

    Attributes:
        known: what was built, alone in a tuple; None before.
    """

    __slots__ = ("_build", "known")

    def __init__(self, build: Callable[[Deadline], T]) -> None:
        self._build = build
        self.known: tuple[T] | None = None

    def __call__(self, deadline: Deadline) -> T:
        """What is built."""
        if self.known is None:
            self.known = (self._build(deadline),)
        return self.known[0]


class StateCache(dict[int, T]):
    """By packed state; it is emptied when all that it holds has more than ``most`` entries."""

    def __init__(self, most: int) -> None:
        super().__init__()
        self._most = most
        self._size = 0

    def keep(self, state: int, found: T, size: int) -> None:
        """Keep something that has ``size`` entries."""
        self._size += size
        if self._size > self._most:
            self.clear()
            self._size = size
        self[state] = found
