"""Progress on stderr: a bar on a terminal, else a line now and then, or JSON for other programs."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Protocol

from serendipity.cli.streams.manner import style
from serendipity.cli.streams.stderr import is_terminal


class News(Protocol):
    """What to call with news of some work."""

    def __call__(self, words: str, **figures: float | None) -> None:
        """Tell it in words; ``figures`` are the same for programs: ``cost``, ``lower_bound``."""


class Count(Protocol):
    """What to call with how far some work is."""

    def __call__(self, done: int, total: int, **figures: float | None) -> None:
        """So much of it is done; ``figures`` are what has been found so far, by name."""


class Display:
    """Something that shows how far some work is; this one shows nothing."""

    def count(self, done: int, total: int, **figures: float | None) -> None:
        """See :class:`Count`."""

    def news(self, words: str, **figures: float | None) -> None:
        """See :class:`News`."""


@contextmanager
def counting(what: str) -> Iterator[Count]:
    """What to call with a number done and the number of all."""
    with _display(what) as display:
        yield display.count


@contextmanager
def working(what: str) -> Iterator[News]:
    """For work of which nobody knows how much is left; what to call with news of it."""
    with _display(what) as display:
        yield display.news


def _display(what: str) -> AbstractContextManager[Display]:
    wanted = style()
    if wanted == "none":
        return nullcontext(Display())
    if wanted == "auto" and is_terminal():
        from serendipity.cli.streams.progress_bar import Bar

        return Bar(what)
    from serendipity.cli.streams.progress_lines import JsonLines, PlainLines

    return JsonLines(what) if wanted == "json" else PlainLines(what)
