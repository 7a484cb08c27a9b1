"""A deadline with a limit of its own for the first phase of a call."""

import time

from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline


class PhaseDeadline(Deadline):
    """Runs out with another deadline, and before that with its own limit until it is lifted.

    Args:
        deadline: the deadline of the call.
        seconds: limit of the phase from now, or None.
    """

    def __init__(self, deadline: Deadline, seconds: float | None) -> None:
        super().__init__()
        self._deadline = deadline
        self._until = None if seconds is None else self.started + seconds

    def lift(self) -> None:
        """From now on only the other deadline counts."""
        self._until = None

    def check(self) -> None:
        """See :class:`Deadline`."""
        self._deadline.check()
        if self._until is not None and time.perf_counter() >= self._until:
            raise LimitReachedError("time-limit")

    def require(self, size: float) -> None:
        """See :class:`Deadline`."""
        self._deadline.require(size)
