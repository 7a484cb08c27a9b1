"""Deadlines of 50 ms, 500 ms and 5 s on generated tasks that take longer than 5 s to prove.

    python -m benchmarks.anytime [--count 100] [--csv FILE] [--seeds 200]

Tasks come from the classes below in turn, seed by seed.  One is taken in if its call with 5 s
ends without a proof; how many were looked at for that is told.  Every call is the first on a
task: as ``serendipity.load`` gives it (``loaded``), and with nothing packed (``bare``), which
the call then has to do in its time.  All modules are loaded before.  A deadline is *kept* if
the call returns within 110 % of it and 5 ms, by the deadline; what the process itself had spent by
then is told beside it, since on a busy machine the deadline also counts what others do.  The gap is
``(objective - lower_bound) / objective`` of the answer.  With ``--csv`` rows are appended, and
a later run with the same file goes on where the first one stopped.
"""

import argparse
import csv
import gc
import statistics
import tempfile
import time
from collections.abc import Iterator
from dataclasses import astuple, dataclass, fields, replace
from pathlib import Path
from typing import Any

import serendipity
from search import prepare
from serendipity import Result, Task
from serendipity.facade.prepared import HELD
from serendipity.model.numbers import as_written

DEADLINES = (5.0, 0.5, 0.05)
"""Seconds; the first one selects."""

SHARE, EXTRA = 0.1, 0.005
"""What may be added to a deadline: of it, and seconds."""

CLASSES: dict[str, tuple[int, int, dict[str, Any]]] = {
    "communication behind his prefix": (420, 3, {"mode": "communication", "keep_prefix": True}),
    "K = 0": (840, 3, {"window_weight": 0}),
    "communication, 5 robots": (840, 5, {"mode": "communication"}),
    "local human": (420, 3, {"human_model": "local"}),
    "observant human": (420, 3, {"human_model": "observant"}),
}
"""Rooms, robots, and what is asked; 2 medkits, discount 0.9."""


@dataclass(frozen=True, slots=True)
class Row:
    """One call.

    Attributes:
        gap: None without an answer, or without a bound.
    """

    kind: str
    seed: int
    loaded: bool
    deadline: float
    status: str
    seconds: float
    processor: float
    gap: float | None
    opportunity: bool

    @property
    def over(self) -> float:
        """Seconds by the deadline beyond the deadline."""
        return self.seconds - self.deadline

    @property
    def kept(self) -> bool:
        """Whether the deadline was kept."""
        return self.over <= SHARE * self.deadline + EXTRA


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=100, help="tasks to take in")
    parser.add_argument("--seeds", type=int, default=200, help="most seeds to look at in each class")
    parser.add_argument("--csv", type=Path, default=None, help="append rows here, and resume from it")
    arguments = parser.parse_args()
    rows = _read(arguments.csv)
    _load_modules()
    for kind, seed in _candidates(arguments.seeds):
        if (kind, seed) in _taken(rows) | _proved(rows):
            continue
        if len(_taken(rows)) >= arguments.count:
            break
        for row in _calls(kind, seed):
            rows.append(row)
            _append(arguments.csv, row)
    _table(rows)


def _load_modules() -> None:
    """Modules load when they are first used; that is no part of a call in a control loop."""
    task = serendipity.example("room2")
    for *_, options in CLASSES.values():
        serendipity.plan(task, discount="0.9", **options)


def _candidates(seeds: int) -> Iterator[tuple[str, int]]:
    for seed in range(seeds):
        for kind in CLASSES:
            yield kind, seed


def _calls(kind: str, seed: int) -> Iterator[Row]:
    rooms, robots, options = CLASSES[kind]
    with tempfile.TemporaryDirectory() as folder:
        edges = rooms // 20 if seed % 2 else 0
        serendipity.generate_usar(folder, rooms=rooms, medkits=2, robots=robots, seed=seed, extra_edges=edges)
        task = serendipity.load(folder)
    for deadline in DEADLINES:
        for loaded in (True, False):
            asked = _bare(task)
            if loaded:
                HELD.hold(prepare(asked))
            row = _call(asked, options, Row(kind, seed, loaded, deadline, "", 0, 0, None, opportunity=False))
            yield row
            if _proves(row):
                return


def _bare(task: Task) -> Task:
    """The task for which nothing is prepared; its variables were found when it was loaded."""
    return task.at(task.init)


def _proves(row: Row) -> bool:
    """Whether it shows that a task does not take long enough."""
    return row.loaded and row.deadline == DEADLINES[0] and row.status in ("optimal", "infeasible")


def _call(task: Task, options: dict[str, Any], row: Row) -> Row:
    gc.collect()
    start, spent = time.perf_counter(), time.process_time()
    result = serendipity.plan(task, discount="0.9", time_limit=row.deadline, **options)
    seconds, processor = time.perf_counter() - start, time.process_time() - spent
    return replace(
        row,
        status=result.status,
        seconds=seconds,
        processor=processor,
        gap=_gap(result),
        opportunity=result.opportunity,
    )


def _gap(result: Result) -> float | None:
    if result.objective is None or result.lower_bound is None:
        return None
    objective, bound = as_written(result.objective), as_written(result.lower_bound)
    return float((objective - bound) / objective) if objective else 0.0


def _proved(rows: list[Row]) -> set[tuple[str, int]]:
    """Candidates that were proved in time."""
    return {(row.kind, row.seed) for row in rows if _proves(row)}


def _taken(rows: list[Row]) -> set[tuple[str, int]]:
    """Candidates of which all calls were made."""
    return {(row.kind, row.seed) for row in rows if not row.loaded and row.deadline == DEADLINES[-1]}


def _table(rows: list[Row]) -> None:
    taken = _taken(rows)
    for kind in CLASSES:
        looked = {row.seed for row in rows if row.kind == kind}
        print(f"{kind}: {sum(k == kind for k, _ in taken)} of {len(looked)} take over {DEADLINES[0]:g} s")
    print(
        f"\n{'task':6}{'deadline':>9}{'calls':>7}{'kept':>7}{'deadline, ms over':>20}{'processor over':>16}",
        end="",
    )
    print(f"{'answered':>10}{'help':>6}{'gap 50 %':>10}{'95 %':>8}")
    for loaded in (True, False):
        for deadline in sorted(DEADLINES):
            members = [
                row
                for row in rows
                if (row.loaded, row.deadline) == (loaded, deadline) and (row.kind, row.seed) in taken
            ]
            if members:
                _line("loaded" if loaded else "bare", deadline, members)


def _line(name: str, deadline: float, rows: list[Row]) -> None:
    over = sorted(row.over * 1000 for row in rows)
    spent = max((row.processor - deadline) * 1000 for row in rows)
    gaps = sorted(row.gap for row in rows if row.gap is not None)
    shown = (
        [f"{gap:.1%}" for gap in (statistics.median(gaps), gaps[int(0.95 * len(gaps))])] if gaps else ["", ""]
    )
    print(
        f"{name:6}{deadline * 1000:>6g} ms{len(rows):>7}{sum(row.kept for row in rows) / len(rows):>7.0%}"
        f"{statistics.median(over):>11.1f}, {over[-1]:>5.1f} max{spent:>12.1f} max"
        f"{sum(row.status != 'unknown' for row in rows):>10}{sum(row.opportunity for row in rows):>6}"
        f"{shown[0]:>10}{shown[1]:>8}"
    )


def _read(file: Path | None) -> list[Row]:
    if file is None or not file.exists():
        return []
    with file.open(newline="", encoding="utf-8") as text:
        return [
            Row(
                kind=row["kind"],
                seed=int(row["seed"]),
                loaded=row["loaded"] == "True",
                deadline=float(row["deadline"]),
                status=row["status"],
                seconds=float(row["seconds"]),
                processor=float(row["processor"]),
                gap=float(row["gap"]) if row["gap"] else None,
                opportunity=row["opportunity"] == "True",
            )
            for row in csv.DictReader(text)
        ]


def _append(file: Path | None, row: Row) -> None:
    if file is None:
        return
    new = not file.exists()
    with file.open("a", newline="", encoding="utf-8") as text:
        writer = csv.writer(text)
        if new:
            writer.writerow([field.name for field in fields(Row)])
        writer.writerow(astuple(row))


if __name__ == "__main__":
    main()
