"""Progress as a bar on a terminal; rich draws it, and is loaded when there is something to draw."""

from threading import Lock, Timer
from typing import TYPE_CHECKING, ClassVar

from serendipity.cli.streams.progress import Display

if TYPE_CHECKING:
    from rich.progress import Progress


class Bar(Display):
    """A bar that appears when the work has taken a while.

    Args:
        what: is worked on.
        counts: whether it is known how much is left.
        stays: the bar is there from the beginning, and stays when all is done.
    """

    patience: ClassVar = 1.0
    """Seconds of work before there is a bar."""

    def __init__(self, what: str, *, counts: bool, stays: bool) -> None:
        self._what = what
        self._state: tuple[str, int, int | None] = (what, 0, None)
        self._counts = counts
        self._stays = stays
        self._bar: Progress | None = None
        self._lock = Lock()
        self._timer = Timer(self.patience, self._appear)
        self._timer.daemon = True

    def open(self) -> None:
        """Show the bar, now or when the work has taken a while."""
        if self._stays:
            self._appear()
        else:
            self._timer.start()

    def count(self, done: int, total: int, **figures: float | None) -> None:
        """Tell how far the work is."""
        found = (f"{value:g} {name}" for name, value in figures.items() if value is not None)
        self._update(", ".join((self._what, *found)), done, total)

    def news(self, words: str, **_figures: float | None) -> None:
        """Tell what has been found."""
        self._update(f"{self._what}: {words}")

    def close(self, *, finished: bool) -> None:
        """Take the bar away, or leave it as it is now."""
        self._timer.cancel()
        with self._lock:
            if self._bar is not None:
                self._bar.stop()

    def _update(self, words: str, done: int = 0, total: int | None = None) -> None:
        with self._lock:
            self._state = (words, done, total)
            self._refresh()

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


def _bar(*, counts: bool, transient: bool) -> "Progress":
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    left = (MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn())
    columns = left if counts else (TimeElapsedColumn(),)
    console = Console(stderr=True)
    return Progress(
        TextColumn("{task.description}"), BarColumn(), *columns, console=console, transient=transient
    )
