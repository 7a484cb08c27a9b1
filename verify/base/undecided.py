"""What leaves a claim undecided, and what was going on when it did."""

from collections.abc import Iterator
from contextlib import contextmanager

from serendipity.model import LimitReachedError
from serendipity.model.errors import limit_reason


class UndecidedError(Exception):
    """Neither a proof nor a counter-example was found; the text says why.

    Attributes:
        bound: no better plan than the one examined has an objective below so many units;
            None where nothing is known.
    """

    def __init__(self, reason: str, bound: int | None = None) -> None:
        super().__init__(reason)
        self.bound = bound


class HumanTooLargeError(UndecidedError):
    """The human's own problem is too large to be checked here."""

    def __init__(self) -> None:
        super().__init__("the human's own problem is too large")


SEARCHING = "searching for what the human can do alone"

UNDECIDED = (UndecidedError, LimitReachedError, MemoryError)
"""What to catch around an examination; :func:`why` puts it into words."""


def why(error: UndecidedError | LimitReachedError | MemoryError, doing: str | None = None) -> str:
    """Why a claim stays undecided, for people; ``doing`` is what was going on when a limit came."""
    if doing is not None and not isinstance(error, UndecidedError):
        return str(LimitReachedError(limit_reason(error), doing))
    return "memory is used up" if isinstance(error, MemoryError) else str(error)


@contextmanager
def during(doing: str) -> Iterator[None]:
    """Work of which a limit says that it came first.

    Args:
        doing: what is going on, for people: ``building the program``.
    """
    try:
        yield
    except LimitReachedError as limit:
        if limit.doing is not None:
            raise
        raise LimitReachedError(limit.reason, doing) from None
    except MemoryError:
        raise LimitReachedError("memory-limit", doing) from None
