"""Limits and progress of reading a task, which all its stages share."""

from collections.abc import Callable
from typing import Final, TypeVar

from serendipity.model import Deadline, LimitReachedError
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.resources.collection import no_collection

T = TypeVar("T")

OnProgress = Callable[[str], None]
"""Is told what is being done whenever that changes, and every few thousand ground actions."""

_LONG: Final = 10**15
"""Numbers from here on are told by their size only."""


class Work:
    """One task being loaded."""

    def __init__(self, deadline: Deadline | None = None, on_progress: OnProgress | None = None) -> None:
        self.deadline = Deadline() if deadline is None else deadline
        self.doing = ""
        self._on_progress = on_progress

    def stage(self, doing: str) -> None:
        """Say what is done from here on, and ask the deadline."""
        self.doing = doing
        if self._on_progress is not None:
            self._on_progress(doing)
        self.deadline.check()

    def require(self, size: float, what: str) -> None:
        """Return if ``size`` bytes more fit into memory; ``what`` says whose they are."""
        try:
            self.deadline.require(size)
        except LimitReachedError as error:
            raise LimitReachedError(error.reason, what) from None


def within_limits(
    load: Callable[[Work], T], deadline: Deadline | None = None, on_progress: OnProgress | None = None
) -> T:
    """The value that ``load`` makes, or a LimitReachedError that says what was being done."""
    work = Work(deadline, on_progress)
    try:
        with no_collection():  # reading makes many tuples, beside which a collection takes long
            return load(work)
    except LIMITS as error:
        reason = limit_reason(error)
        doing = error.doing if isinstance(error, LimitReachedError) else None
    # Raised out here, where nothing refers to what was made so far, and all of it can go.
    raise LimitReachedError(reason, doing or "reading the task" + (f" ({work.doing})" if work.doing else ""))


def about(number: int) -> str:
    """An estimate for people: ``4,477,456``, or ``10^28`` where it is longer than a line."""
    return f"{number:,}" if number < _LONG else f"10^{len(str(number)) - 1}"
