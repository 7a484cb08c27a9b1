"""A clock with a limit of its own for the first phase of a call."""

import time

from search.clock import Clock, OutOfTimeError


class PhaseClock(Clock):
    """Runs out with another clock, and before that with its own limit until it is lifted.

    Args:
        clock: the clock of the call.
        seconds: limit of the phase from now, or None.
    """

    def __init__(self, clock: Clock, seconds: float | None) -> None:
        super().__init__()
        self._clock = clock
        self._until = None if seconds is None else self.started + seconds

    def lift(self) -> None:
        """From now on only the other clock counts."""
        self._until = None

    def check(self) -> None:
        """See :class:`Clock`."""
        self._clock.check()
        if self._until is not None and time.perf_counter() >= self._until:
            raise OutOfTimeError
