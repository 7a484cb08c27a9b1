"""Deadlines of 50 ms, 500 ms and 5 s on generated tasks that take longer than 5 s to prove.

    python -m benchmarks.anytime [--count 100] [--record FILE] [--seeds 200]

Tasks come from the classes below in turn, seed by seed.  One is taken in if its call with 5 s
ends without a proof; how many were looked at for that is told.  Every call is the first on a
task: as ``serendipity.load`` gives it (``loaded``), and with nothing packed (``bare``), which
the call then has to do in its time.  All modules are loaded before.  A deadline is *kept* if
the call returns within 110 % of it and 5 ms, by the deadline; what the process itself had spent by
then is told beside it, since on a busy machine the deadline also counts what others do.  The gap is
``(objective - lower_bound) / objective`` of the answer.  With ``--record`` a later run with the same file
goes on where the first one stopped.
"""

import gc
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import typer

import serendipity
from search import prepare
from serendipity import Result, Task
from serendipity.evaluation.measuring.figures import percentile
from serendipity.evaluation.measuring.record import Record
from serendipity.evaluation.measuring.running import measured
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.facade.prepared import HELD
from serendipity.model.numbers import as_written
from serendipity.model.telling import Line

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

Row = Mapping[str, Any]
"""Of one call: ``start``, ``deadline``, ``status``, ``over`` and ``spent`` (seconds beyond the deadline, by
the clock and of the process), ``gap`` (None without an answer, or a bound), ``help``."""


@dataclass(frozen=True, slots=True)
class Job:
    """A task: its class and its seed."""

    kind: str
    seed: int


def main(count: int = 100, seeds: int = 200, record: Path | None = None) -> None:
    """Measure and print a table."""
    task = serendipity.example("room2")
    for *_, options in CLASSES.values():  # modules load when they are first used: no part of a call in a loop
        serendipity.plan(task, discount="0.9", **options)
    looked, rows, taken = dict.fromkeys(CLASSES, 0), [], dict.fromkeys(CLASSES, 0)
    candidates = (Job(kind, seed) for seed, kind in product(range(seeds), CLASSES))
    for job, found in measured(candidates, calls, Record(record)):
        looked[job.kind] += 1
        if len(found) > 1:
            taken[job.kind] += 1
            rows += found
        if sum(taken.values()) >= count:
            break
    told = [Line(f"{kind}: {taken[kind]} of {looked[kind]} take over {DEADLINES[0]:g} s") for kind in CLASSES]
    print(as_markdown([*told, _table(rows)]), end="")


def calls(job: Job) -> list[Row]:
    """All calls on a task; the first one alone where that shows that it does not take long enough."""
    rooms, robots, options = CLASSES[job.kind]
    with tempfile.TemporaryDirectory() as folder:
        edges = rooms // 20 if job.seed % 2 else 0
        serendipity.generate_usar(
            folder, rooms=rooms, medkits=2, robots=robots, seed=job.seed, extra_edges=edges
        )
        task = serendipity.load(folder)
    rows: list[Row] = []
    for deadline, start in product(DEADLINES, ("loaded", "bare")):
        asked = task.at(task.init)  # nothing is prepared; its variables were found when it was loaded
        if start == "loaded":
            HELD.hold(prepare(asked))
        rows.append({"start": start, "deadline": deadline, **_called(asked, options, deadline)})
        if rows[0]["status"] in ("optimal", "infeasible"):
            break
    return rows


def _called(task: Task, options: dict[str, Any], deadline: float) -> dict[str, Any]:
    gc.collect()
    start, spent = time.perf_counter(), time.process_time()
    result = serendipity.plan(task, discount="0.9", time_limit=deadline, **options)
    over, spent = time.perf_counter() - start - deadline, time.process_time() - spent - deadline
    said = {"status": result.status, "gap": _gap(result), "help": result.opportunity}
    return {"over": over, "spent": spent, **said}


def _gap(result: Result) -> float | None:
    if result.objective is None or result.lower_bound is None:
        return None
    objective, bound = as_written(result.objective), as_written(result.lower_bound)
    return float((objective - bound) / objective) if objective else 0.0


def _table(rows: Sequence[Row]) -> Any:
    def gap(of: Sequence[Row], share: float) -> str:
        known = [row["gap"] for row in of if row["gap"] is not None]
        return f"{percentile(known, share):.1%}" if known else ""

    return table(
        ("task", "deadline"),
        grouped(rows, lambda row: (str(row["start"]), f"{row['deadline'] * 1000:g} ms")),
        {
            "calls": len,
            "kept": lambda of: sum(row["over"] <= SHARE * row["deadline"] + EXTRA for row in of),
            "over it: median": lambda of: f"{1000 * percentile([row['over'] for row in of], 0.5):.1f} ms",
            "most": lambda of: f"{1000 * max(row['over'] for row in of):.1f} ms",
            "processor, most": lambda of: f"{1000 * max(row['spent'] for row in of):.1f} ms",
            "answered": lambda of: sum(row["status"] != "unknown" for row in of),
            "help": lambda of: sum(row["help"] for row in of),
            "gap: median": lambda of: gap(of, 0.5),
            "95 %": lambda of: gap(of, 0.95),
        },
    )


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
