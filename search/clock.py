"""Deadline and cancellation, asked for often and cheaply."""

import threading
import time

_EVERY = 31
"""All ones in binary: ticks between two looks at the time, less one."""


class OutOfTimeError(Exception):
    """The deadline has passed or the caller has cancelled; incumbents stay valid."""


class Clock:
    """A deadline and a cancel flag.

    Args:
        time_limit: seconds from now, or None for no limit.
        cancelled: set from another thread to stop the search.
    """

    def __init__(self, time_limit: float | None = None, cancelled: threading.Event | None = None) -> None:
        self.started = time.perf_counter()
        self._deadline = None if time_limit is None else self.started + time_limit
        self._cancelled = cancelled
        self._ticks = 0

    def elapsed(self) -> float:
        """Seconds since the clock was made."""
        return time.perf_counter() - self.started

    def tick(self) -> None:
        """:meth:`check`, every so many calls: for loops whose rounds take microseconds."""
        self._ticks += 1
        if not self._ticks & _EVERY:
            self.check()

    def check(self) -> None:
        """Return while there is time.

        Raises:
            OutOfTimeError: there is none.
        """
        if self._deadline is not None and time.perf_counter() >= self._deadline:
            raise OutOfTimeError
        if self._cancelled is not None and self._cancelled.is_set():
            raise OutOfTimeError
