"""What leaves a claim undecided."""

from serendipity.model import LimitReachedError


class UndecidedError(Exception):
    """Neither a proof nor a counter-example was found; the text says why.

    Attributes:
        bound: no better plan than the one examined has an objective below so many units;
            None where nothing is known.
    """

    def __init__(self, reason: str, bound: int | None = None) -> None:
        super().__init__(reason)
        self.bound = bound


class TooManyStatesError(UndecidedError):
    """The human's own problem is too large to be checked here."""

    def __init__(self) -> None:
        super().__init__("the human's own problem is too large")


UNDECIDED = (UndecidedError, LimitReachedError, MemoryError)
"""What to catch around an examination; :func:`why` puts it into words."""


def why(error: UndecidedError | LimitReachedError | MemoryError) -> str:
    """Why a claim stays undecided, for people."""
    return "memory is used up" if isinstance(error, MemoryError) else str(error)
