"""Reading, searching, a whole process and its memory, on folders of the layout of the paper's 200.

    python -m benchmarks.usar [FOLDER] [--stride N]

*Reading* is parsing, uniting and grounding with the files in the page cache, after a
warm-up: ``warm`` keeps what was parsed of equal domain texts, ``cold`` forgets it before
each task.  *Preparing* is what ``serendipity.load`` does besides: packed actions and what
depends on them alone.  *Search* is the planning calls with six discounts, one after another, on a
prepared task: every table that a call builds is inside its time, the next ones find it.
All of it is processor time but the whole process, which is by the deadline.
There is no garbage collection while something is timed: a caller has one task in memory, not 200.
"""

import argparse
import gc
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.problems import PROBLEMS
from search import prepare, solve
from serendipity.model import Options, Task
from serendipity.model.resources.collection import no_collection
from serendipity.pddl import forget_parsed, read_folder

DISCOUNTS = ("0", "0.1", "0.3", "0.5", "0.7", "0.9")
MODES = {
    "serendipity": {},
    "communication": {},
    "composite": {},
    "composite without horizon": {"mode": "composite", "horizon": "inf"},
}


def main() -> None:
    """Print a table of medians, 95th percentiles and maxima."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=PROBLEMS / "usar200")
    parser.add_argument("--stride", type=int, default=1, help="take every N-th task")
    options = parser.parse_args()
    folders = sorted(options.folder.glob("test*"), key=lambda p: int(p.name.removeprefix("test")))
    folders = folders[:: options.stride]
    if not folders:
        sys.exit(f"no folders test1, test2, ... in {options.folder}")
    print(f"{len(folders)} tasks of {options.folder.name}; Python {sys.version.split()[0]}")
    print(f"{'':60}{'p50':>9}{'p95':>9}{'max':>9}")
    _process(folders[0])  # first: what a process needs is counted from what its parent has
    _reading(folders)
    tasks = [read_folder(folder) for folder in folders]
    gc.collect()
    _row("preparing, once a task", [_timed(lambda task=task: prepare(task)) for task in tasks])
    for mode, options in MODES.items():
        _searching(tasks, mode, {"mode": mode, **options})
    print(f"\npeak memory with all tasks loaded: {_peak(resource.RUSAGE_SELF):.0f} MiB")


def _reading(folders: list[Path]) -> None:
    read_folder(folders[0])
    gc.collect()
    _row("reading, warm", [_timed(lambda folder=folder: read_folder(folder)) for folder in folders])
    cold = []
    for folder in folders:
        forget_parsed()
        cold.append(_timed(lambda folder=folder: read_folder(folder)))
    _row("reading, nothing kept", cold)


def _searching(tasks: list[Task], name: str, options: dict[str, Any]) -> None:
    first, others = [], []
    for task in tasks:
        prepared = prepare(task)
        for discount in DISCOUNTS:
            chosen = Options(discount=discount, **options)
            seconds = _timed(lambda prepared=prepared, chosen=chosen: list(solve(prepared, chosen)))
            (others if discount != DISCOUNTS[0] else first).append(seconds)
    _row(f"search, {name}, six discounts in turn", first + others)
    _row("   the first of them", first)
    _row("   the other five", others)


def _process(folder: Path) -> None:
    command = [sys.executable, "-m", "serendipity", "plan", str(folder), "--discount", "0.9", "--quiet"]
    subprocess.run(command, check=True, capture_output=True)
    times = []
    for _ in range(9):
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    _row("whole process: serendipity plan FOLDER", times)
    print(f"its peak memory: {_peak(resource.RUSAGE_CHILDREN):.0f} MiB")


def _timed(work: Callable[[], object]) -> float:
    with no_collection():
        start = time.process_time()
        work()
        return time.process_time() - start


def _row(name: str, seconds: list[float]) -> None:
    ordered = sorted(seconds)
    p95 = ordered[min(len(ordered) - 1, int(len(ordered) * 0.95))]
    figures = (statistics.median(ordered), p95, ordered[-1])
    print(f"{name:60}" + "".join(f"{value * 1000:7.2f}ms" for value in figures))


def _peak(who: int) -> float:
    return resource.getrusage(who).ru_maxrss / 1024


if __name__ == "__main__":
    main()
