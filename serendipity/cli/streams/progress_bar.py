"""Progress as a bar on a terminal; rich draws it, and is loaded when there is something to draw."""

from typing import TYPE_CHECKING

from serendipity.cli.streams.progress_lines import RepeatedDisplay

if TYPE_CHECKING:
    from rich.progress import Progress


class Bar(RepeatedDisplay):
    """A bar that appears when the work has taken a while, and is gone when that is over."""

    first, growth = 1.0, 1.0
    _bar: "Progress | None" = None

    def say(self) -> None:
        """See the base."""
        if self._bar is None:
            self._bar = _bar(counts=self.first_done is not None)
            self._bar.add_task("", total=None)
            self._bar.start()
        words = ": ".join(part for part in (self.what, self.words) if part)
        self._bar.update(
            self._bar.task_ids[0], description=words, total=self.total or None, completed=self.done
        )

    def end(self, *, finished: bool) -> None:
        """See the base."""
        if self._bar is not None:
            self._bar.stop()


def _bar(*, counts: bool) -> "Progress":
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
    return Progress(TextColumn("{task.description}"), BarColumn(), *columns, console=console, transient=True)
