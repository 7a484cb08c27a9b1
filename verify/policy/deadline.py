"""When to give up."""

import time


class UndecidedError(Exception):
    """A claim could be neither proved nor refuted; its text says why."""


class Deadline:
    """A point in time after which claims stay undecided.

    Args:
        time_limit: seconds from now, or None.
    """

    def __init__(self, time_limit: float | None) -> None:
        self._end = None if time_limit is None else time.perf_counter() + time_limit

    def check(self) -> None:
        """Return while there is time.

        Raises:
            UndecidedError: there is none.
        """
        self.require(self._end is None or time.perf_counter() < self._end, "the time limit came first")

    def require(self, holds: bool, otherwise: str) -> None:
        """Return if ``holds``.

        Raises:
            UndecidedError: it does not.
        """
        if not holds:
            raise UndecidedError(otherwise)
