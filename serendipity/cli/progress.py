"""Progress on stderr: a bar on a terminal, lines in a log (``-v``), nothing where it is piped."""

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

from serendipity.reproduction import Progress

log = logging.getLogger("serendipity.progress")


@contextmanager
def shown(*, quiet: bool) -> Iterator[Callable[[Progress], None]]:
    """What to call with the progress made."""
    if quiet:
        yield lambda _: None
    elif sys.stderr.isatty():
        with _bar() as report:
            yield report
    else:
        yield _logged()


@contextmanager
def _bar() -> Iterator[Callable[[Progress], None]]:
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
    with Bar(*columns, console=Console(stderr=True)) as bar:
        line = bar.add_task("tasks", total=None)

        def report(progress: Progress) -> None:
            words = f"tasks, {progress.opportunities} opportunities"
            bar.update(line, description=words, total=progress.total, completed=progress.done)

        yield report


def _logged() -> Callable[[Progress], None]:
    start = monotonic()
    first: list[int] = []

    def report(progress: Progress) -> None:
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
