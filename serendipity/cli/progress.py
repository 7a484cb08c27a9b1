"""Progress on stderr: a bar on a terminal, lines in a log (``-v``), nothing where it is piped."""

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock, Timer
from time import monotonic
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

    from serendipity.reproduction import Progress

log = logging.getLogger("serendipity.progress")

_PATIENCE: Final = 1.0
"""Seconds before there is anything to see, and between two lines of a log."""


@contextmanager
def shown(*, quiet: bool) -> Iterator[Callable[["Progress"], None]]:
    """What to call with the progress made on a suite; its bar stays."""
    if quiet:
        yield lambda _: None
    elif sys.stderr.isatty():
        with _display("tasks", counts=True, stays=True) as display:

            def report(progress: "Progress") -> None:
                words = f"tasks, {progress.opportunities} opportunities"
                display.update(words, progress.done, progress.total)

            yield report
    else:
        yield _logged()


@contextmanager
def counting(what: str, *, quiet: bool) -> Iterator[Callable[[int, int], None]]:
    """What to call with a number done and the number of all."""
    if quiet:
        yield lambda _done, _total: None
    elif sys.stderr.isatty():
        with _display(what, counts=True) as display:
            yield lambda done, total: display.update(what, done, total)
    else:
        said = [monotonic()]

        def report(done: int, total: int) -> None:
            if monotonic() - said[0] >= _PATIENCE:
                said[0] = monotonic()
                log.info("%d of %d %s", done, total, what)

        yield report


@contextmanager
def working(what: str, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """For work of which nobody knows how much is left; what to call with news of it."""
    if quiet:
        yield lambda _: None
    elif sys.stderr.isatty():
        with _display(what, counts=False) as display:
            yield lambda news: display.update(f"{what}: {news}")
    else:
        started = monotonic()
        timer = Timer(_PATIENCE, log.info, ("%s", what))
        timer.daemon = True
        timer.start()
        try:
            yield lambda news: log.info("%s: %s, after %.1f s", what, news, monotonic() - started)
        finally:
            timer.cancel()
        if monotonic() - started >= _PATIENCE:
            log.info("%s: done after %.1f s", what, monotonic() - started)


class _Display:
    """A bar that appears when the work has taken a while, or one that is there from beginning to end."""

    def __init__(self, what: str, *, counts: bool, stays: bool) -> None:
        self._state: tuple[str, int, int | None] = (what, 0, None)
        self._counts = counts
        self._stays = stays
        self._bar: Bar | None = None
        self._lock = Lock()
        self._timer = Timer(_PATIENCE, self._appear)
        self._timer.daemon = True

    def open(self) -> None:
        """Show the bar, now or when the work has taken a while."""
        if self._stays:
            self._appear()
        else:
            self._timer.start()

    def update(self, words: str, done: int = 0, total: int | None = None) -> None:
        """Tell how far the work is."""
        with self._lock:
            self._state = (words, done, total)
            self._refresh()

    def close(self) -> None:
        """Take the bar away, or leave it as it is now."""
        self._timer.cancel()
        with self._lock:
            if self._bar is not None:
                self._bar.stop()

    def _appear(self) -> None:
        bar = _bar(counts=self._counts, transient=not self._stays)
        with self._lock:
            if self._timer.finished.is_set():
                return
            self._bar = bar
            bar.add_task("", total=None)
            self._refresh()
            bar.start()

    def _refresh(self) -> None:
        if self._bar is not None:
            words, done, total = self._state
            self._bar.update(self._bar.task_ids[0], description=words, total=total, completed=done)


@contextmanager
def _display(what: str, *, counts: bool, stays: bool = False) -> Iterator[_Display]:
    display = _Display(what, counts=counts, stays=stays)
    try:
        display.open()
        yield display
    finally:
        display.close()


def _bar(*, counts: bool, transient: bool) -> "Bar":
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bar

    left = (MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn())
    columns = left if counts else (TimeElapsedColumn(),)
    console = Console(stderr=True)
    return Bar(TextColumn("{task.description}"), BarColumn(), *columns, console=console, transient=transient)


def _logged() -> Callable[["Progress"], None]:
    start = monotonic()
    first: list[int] = []

    def report(progress: "Progress") -> None:
        first[:] = first or [progress.done]
        worked = progress.done - first[0]
        left = (monotonic() - start) / worked * (progress.total - progress.done) if worked else None
        log.info(
            "%d of %d tasks, %d opportunities%s",
            progress.done,
            progress.total,
            progress.opportunities,
            "" if left is None else f", {left:.0f} s left",
        )

    return report
