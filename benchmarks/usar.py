"""Reading, preparing, a whole process and its memory, on folders of the layout of the paper's 200.

    python -m benchmarks.usar [FOLDER] [--stride N]

*Reading* is parsing, uniting and grounding with the files in the page cache, and nothing kept of equal
domain texts.  *Preparing* is what ``serendipity.load`` does besides: packed actions and what depends on
them alone.  The search itself is what ``serendipity bench`` measures.  Processor time in milliseconds, but
the whole process by the clock.
There is no garbage collection while something is timed: a caller has one task in memory, not 200.
"""

import gc
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from benchmarks.problems import PROBLEMS, run
from search import prepare
from serendipity.evaluation.measuring.figures import children_memory, machine, peak_memory, timed
from serendipity.evaluation.measuring.suites import folders
from serendipity.evaluation.measuring.tables import as_markdown, spreads
from serendipity.model.telling import Grid, Line
from serendipity.pddl import forget_parsed, read_folder


def main(folder: Annotated[Path, typer.Argument()] = PROBLEMS / "usar200", stride: int = 1) -> None:
    """Print a table of medians, 95th percentiles and maxima."""
    places = folders(folder, stride)
    whole = _processes(places[0])  # first: memory is its parent's, too
    memory = children_memory()
    tasks = [read_folder(place) for place in places]
    gc.collect()
    rows = [
        _row("whole process: serendipity plan FOLDER", whole),
        _row("reading", [_cold(place) for place in places]),
        _row("preparing, once a task", [timed(lambda t=task: prepare(t))[1] for task in tasks]),
    ]
    told = f"Peak memory: {memory:.0f} MiB of a process, {peak_memory():.0f} MiB with all tasks loaded."
    header = ("milliseconds", "median", "95 %", "longest")
    print(as_markdown([Line(f"{len(places)} tasks; {machine()}"), Grid(header, rows), Line(told)]), end="")


def _row(name: str, seconds: Sequence[float]) -> Sequence[str]:
    (row,) = spreads(seconds, {name: lambda each: 1000 * each}, digits=2).rows
    return row


def _processes(folder: Path) -> list[float]:
    command = [sys.executable, "-m", "serendipity", "plan", str(folder), "--discount", "0.9", "--quiet"]
    times = []
    for _ in range(10):
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    return times[1:]


def _cold(folder: Path) -> float:
    forget_parsed()
    return timed(lambda: read_folder(folder))[1]


if __name__ == "__main__":
    run(main, __doc__)
