"""Progress on stderr: a bar on a terminal, else a line now and then, or JSON for other programs."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

from serendipity.cli.streams.manner import style
from serendipity.cli.streams.stderr import is_terminal

if TYPE_CHECKING:
    from serendipity.evaluation.reproduction import Progress


class News(Protocol):
    """What to call with news of some work."""

    def __call__(self, words: str, **figures: float | None) -> None:
        """Tell it in words; ``figures`` are the same for programs: ``cost``, ``lower_bound``."""


class Display:
    """Something that shows how far some work is; this one shows nothing."""

    def open(self) -> None:
        """The work begins."""

    def count(self, done: int, total: int, **figures: float | None) -> None:
        """So much of it is done; ``figures`` are what has been found so far, by name."""

    def news(self, words: str, **figures: float | None) -> None:
        """There is something better than before."""

    def close(self, *, finished: bool) -> None:
        """The work is over, or broken off."""


@contextmanager
def shown() -> Iterator[Callable[["Progress"], None]]:
    """What to call with the progress made on a suite; its bar is there from beginning to end."""
    with _displayed("tasks", counts=True, stays=True) as display:
        yield lambda made: display.count(made.done, made.total, opportunities=made.opportunities)


@contextmanager
def counting(what: str) -> Iterator[Callable[[int, int], None]]:
    """What to call with a number done and the number of all."""
    with _displayed(what, counts=True) as display:
        yield lambda done, total: display.count(done, total)


@contextmanager
def working(what: str) -> Iterator[News]:
    """For work of which nobody knows how much is left; what to call with news of it."""
    with _displayed(what) as display:
        yield display.news


@contextmanager
def _displayed(what: str, *, counts: bool = False, stays: bool = False) -> Iterator[Display]:
    display = _display(what, counts=counts, stays=stays)
    display.open()
    finished = False
    try:
        yield display
        finished = True
    finally:
        display.close(finished=finished)


def _display(what: str, *, counts: bool, stays: bool) -> Display:
    wanted = style()
    if wanted == "none":
        return Display()
    if wanted == "auto" and is_terminal():
        from serendipity.cli.streams.progress_bar import Bar

        return Bar(what, counts=counts, stays=stays)
    from serendipity.cli.streams.progress_lines import JsonLines, PlainLines

    return JsonLines(what) if wanted == "json" else PlainLines(what)
