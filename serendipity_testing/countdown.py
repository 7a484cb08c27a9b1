"""A deadline that runs out at a given look at it."""

from collections.abc import Callable

from serendipity.model import Deadline, LimitReachedError


def time_is_up() -> Exception:
    """The error of a deadline whose time is up."""
    return LimitReachedError("time-limit")


class Countdown(Deadline):
    """Runs out at the ``looks``-th look, ticks and requests for memory included, or at that look alone.

    Args:
        once: whether the looks after that one are free, as memory may be again.
    """

    def __init__(
        self, looks: int, limit: Callable[[], Exception] = time_is_up, *, once: bool = False
    ) -> None:
        super().__init__()
        self._limit = limit
        self._once = once
        self.left_over = [looks]  # shared with copies, which are this deadline for a part of the work

    @property
    def ran_out(self) -> bool:
        """Whether it has."""
        return self.left_over[0] < 0

    def check(self) -> None:
        """See :class:`Deadline`."""
        self.left_over[0] -= 1
        if self.left_over[0] == -1 or (self.ran_out and not self._once):
            raise self._limit()

    tick = check

    def require(self, size: float) -> None:
        """See :class:`Deadline`."""
        del size
        self.check()
