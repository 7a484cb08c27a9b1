"""A cache by state that is emptied when it holds too much."""

from typing import TypeVar

T = TypeVar("T")


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
