"""Limits on time and memory of a call: polled often, and cheaply.

Reading, searching and verifying share this, and nothing else, with each other.  It is no risk to
the verifier's independence: all that a deadline can do is to leave a claim undecided.
"""

import threading
import time
from collections.abc import Iterable, Iterator
from copy import copy
from itertools import islice
from typing import Final, TypeVar

from serendipity.model.errors import LIMITS, LimitReachedError, UsageError, limit_reason
from serendipity.model.resources.memory import available, resident

T = TypeVar("T")

MIB: Final = 2**20

_EVERY: Final = 31
"""All ones in binary: ticks between two looks at the time, less one."""

_BATCH: Final = 64
"""Items between two looks in :meth:`Deadline.each`."""

_MEMORY_EVERY: Final = 0.005
"""Seconds between two looks at the memory, which cost ten times as much as one at the time."""


class Deadline:
    """A time limit, a memory limit and a cancel flag; whoever works for long polls it.

    Inside the planner and the verifier, whoever is given one raises ``LimitReachedError`` when it
    comes; docstrings there say so only where there is more to say, as what stays known.

    Args:
        time_limit: seconds from now, or None for no limit.
        memory_limit: what the whole process may have in memory, in MiB, or None for no limit.
        cancelled: set from another thread to end the work.

    Raises:
        UsageError: a limit is no number, or one on memory where the system does not say how much is used.
    """

    def __init__(
        self,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        cancelled: threading.Event | None = None,
    ) -> None:
        _require_number("time_limit", time_limit)
        _require_number("memory_limit", memory_limit)
        self.started = time.perf_counter()
        self._end = None if time_limit is None else self.started + time_limit
        self._most = None if memory_limit is None else memory_limit * MIB
        self._cancelled: tuple[threading.Event, ...] = () if cancelled is None else (cancelled,)
        self._ticks = 0
        self._measure_at = self.started
        if memory_limit is not None and resident() is None:
            raise UsageError("memory_limit: this system does not say how much memory a process uses")

    def elapsed(self) -> float:
        """Seconds since the deadline was set."""
        return time.perf_counter() - self.started

    def left(self) -> float | None:
        """Seconds that are left, at least 0; None without a time limit."""
        return None if self._end is None else max(self._end - time.perf_counter(), 0.0)

    def within(
        self,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        cancelled: threading.Event | None = None,
    ) -> "Deadline":
        """A deadline for a part of the work, starting now: its own limits, and never beyond this one's.

        Args:
            time_limit: seconds from now on, or None.
            memory_limit: what the process may have in memory, in MiB, or None.
            cancelled: ends the part when it is set, as what ends the whole does.
        """
        own = Deadline(time_limit, memory_limit, cancelled)
        part = copy(self)
        part.started = own.started
        part._end = _least(own._end, self._end)
        part._most = _least(own._most, self._most)
        part._cancelled = self._cancelled + own._cancelled
        return part

    def part(self, share: float) -> "Deadline":
        """A deadline for a part of the work: a share of the time that is left, where time is limited."""
        left = self.left()
        return self if left is None else self.within(share * left)

    def sooner(self, share: float) -> "Deadline":
        """The same deadline without the last ``share`` of its time, kept for what comes at the end."""
        part = copy(self)
        if self._end is not None:
            part._end = self._end - share * (self._end - self.started)
        return part

    def renew(self, other: "Deadline") -> None:
        """Take over another's time and limits, for whatever polls this one through several calls."""
        self.started = other.started
        self._end, self._most, self._cancelled = other._end, other._most, other._cancelled

    def tick(self) -> None:
        """:meth:`check`, every so many calls: for loops whose rounds take microseconds."""
        self._ticks += 1
        if not self._ticks & _EVERY:
            self.check()

    def each(self, items: Iterable[T], batch: int = _BATCH) -> Iterator[T]:
        """The items, with a :meth:`check` before each batch of them: for long loops and comprehensions."""
        source = iter(items)
        while some := tuple(islice(source, batch)):
            self.check()
            yield from some

    def check(self) -> None:
        """Return while there is time and memory.

        Raises:
            LimitReachedError: there is none, or the work is cancelled.
        """
        if self._end is not None and time.perf_counter() >= self._end:
            raise LimitReachedError("time-limit")
        for cancelled in self._cancelled:
            if cancelled.is_set():
                raise LimitReachedError("cancelled")
        if self._most is not None:
            self._check_memory(self._most)

    def reached(self) -> str | None:
        """The limit that has come, as ``Result.reason`` has it; None while there is time and memory."""
        try:
            self.check()
        except LIMITS as limit:
            return limit_reason(limit)
        return None

    def require(self, size: float) -> None:
        """Return if ``size`` bytes more fit, into the limit or, without one, into what the machine has left.

        To be asked before much is allocated at once, with an estimate of it.

        Raises:
            LimitReachedError: they don't.
        """
        if size < MIB:  # looking at what there is takes as long as filling that much
            return
        used = resident() if self._most is not None else None
        room = available() if used is None or self._most is None else self._most - used
        if room is not None and size > room:
            raise LimitReachedError("memory-limit")

    def check_child(self, pid: int) -> None:
        """:meth:`check` for one who waits for a process of ours: what it has in memory counts, too."""
        self.check()
        if self._most is not None:
            used, beside = resident(), resident(pid)
            if used is not None and beside is not None and used + beside > self._most:
                raise LimitReachedError("memory-limit")

    def _check_memory(self, most: float) -> None:
        now = time.perf_counter()
        if now < self._measure_at:
            return
        self._measure_at = now + _MEMORY_EVERY
        used = resident()
        if used is not None and used > most:
            raise LimitReachedError("memory-limit")


def _least(a: float | None, b: float | None) -> float | None:
    return b if a is None else a if b is None else min(a, b)


def _require_number(name: str, value: object) -> None:
    if value is not None and not isinstance(value, int | float):
        raise UsageError(f"{name}: expected a number, got {value!r:.50}")
