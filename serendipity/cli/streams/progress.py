"""Progress on stderr: a bar on a terminal, else a line now and then, or JSON for other programs."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Final, Protocol

from serendipity.cli.streams.stderr import is_terminal
from serendipity.model.errors import UsageError

if TYPE_CHECKING:
    from serendipity.evaluation.reproduction import Progress

STYLES: Final = ("auto", "plain", "json", "none")
"""``auto``: a bar on a terminal, plain lines elsewhere."""

_style: ContextVar[str] = ContextVar("style", default="auto")


def choose(style: str) -> None:
    """Set how progress is shown in this call of the command line.

    Raises:
        UsageError: there is no such style.
    """
    if style not in STYLES:
        raise UsageError(f"--progress: expected one of {', '.join(STYLES)}, got '{style}'")
    _style.set(style)


class News(Protocol):
    """What to call with news of some work."""

    def __call__(self, words: str, **figures: float | None) -> None:
        """Tell it in words; ``figures`` are the same for programs: ``cost``, ``lower_bound``."""


class Display(Protocol):
    """Something that shows how far some work is."""

    def open(self) -> None:
        """The work begins."""

    def count(self, done: int, total: int, **figures: float | None) -> None:
        """So much of it is done; ``figures`` are what has been found so far, by name."""

    def news(self, words: str, **figures: float | None) -> None:
        """There is something better than before."""

    def close(self, *, finished: bool) -> None:
        """The work is over, or broken off."""


@contextmanager
def shown(*, quiet: bool) -> Iterator[Callable[["Progress"], None]]:
    """What to call with the progress made on a suite; its bar is there from beginning to end."""
    with _displayed("tasks", quiet=quiet, counts=True, stays=True) as display:
        yield lambda made: display.count(made.done, made.total, opportunities=made.opportunities)


@contextmanager
def counting(what: str, *, quiet: bool) -> Iterator[Callable[[int, int], None]]:
    """What to call with a number done and the number of all."""
    with _displayed(what, quiet=quiet, counts=True) as display:
        yield lambda done, total: display.count(done, total)


@contextmanager
def working(what: str, *, quiet: bool) -> Iterator[News]:
    """For work of which nobody knows how much is left; what to call with news of it."""
    with _displayed(what, quiet=quiet) as display:
        yield display.news


@contextmanager
def _displayed(what: str, *, quiet: bool, counts: bool = False, stays: bool = False) -> Iterator[Display]:
    display = _display(what, quiet=quiet, counts=counts, stays=stays)
    display.open()
    finished = False
    try:
        yield display
        finished = True
    finally:
        display.close(finished=finished)


def _display(what: str, *, quiet: bool, counts: bool, stays: bool) -> Display:
    style = _style.get()
    if style == "none" or quiet:
        return _Silent()
    if style == "auto" and is_terminal():
        from serendipity.cli.streams.progress_bar import Bar

        return Bar(what, counts=counts, stays=stays)
    from serendipity.cli.streams.progress_lines import JsonLines, PlainLines

    return JsonLines(what) if style == "json" else PlainLines(what)


class _Silent:
    """Shows nothing."""

    def open(self) -> None:
        """See :class:`Display`."""

    def count(self, done: int, total: int, **figures: float | None) -> None:
        """See :class:`Display`."""

    def news(self, words: str, **figures: float | None) -> None:
        """See :class:`Display`."""

    def close(self, *, finished: bool) -> None:
        """See :class:`Display`."""
