"""Progress on stderr: a bar on a terminal, lines in a log (``-v``), nothing where it is piped."""

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

    from serendipity.reproduction import Progress

log = logging.getLogger("serendipity.progress")


@contextmanager
def shown(*, quiet: bool) -> Iterator[Callable[["Progress"], None]]:
    """What to call with the progress made."""
    if quiet:
        yield lambda _: None
    elif sys.stderr.isatty():
        with _bar() as report:
            yield report
    else:
        yield _logged()


@contextmanager
def counting(what: str, *, quiet: bool) -> Iterator[Callable[[int, int], None] | None]:
    """What to call with a number done and the number of all; None where nothing is shown."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    with _display(transient=True) as (bar, line):

        def report(done: int, total: int) -> None:
            bar.update(line, description=what, total=total, completed=done)

        yield report


@contextmanager
def _bar() -> Iterator[Callable[["Progress"], None]]:
    with _display(transient=False) as (bar, line):

        def report(progress: "Progress") -> None:
            words = f"tasks, {progress.opportunities} opportunities"
            bar.update(line, description=words, total=progress.total, completed=progress.done)

        yield report


@contextmanager
def _display(*, transient: bool) -> "Iterator[tuple[Bar, TaskID]]":
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=Console(stderr=True), transient=transient) as bar:
        yield bar, bar.add_task("", total=None)


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
