"""How far ``verify`` overruns its time limit, and what memory it takes.

    python -m benchmarks.limits [TASK ...] [--rooms ROOMS,MEDKITS ...] [--limit SECONDS ...] [--csv FILE]

A TASK is ``FOLDER:HUMAN`` or ``DOMAIN:PROBLEM:HUMAN:ROBOT[:ROBOT...]``; ``--rooms`` generates buildings.
Each task is planned for 2 seconds in each of three ways, and each answer is verified under each
limit in a process of its own.  The time is that of the call alone; beside it stands the
processor's, solvers included, since other work on the machine delays a call but is no overrun of its
own.  Memory is the most that the process had, and the most of a solver's process.
"""

import argparse
import csv
import os
import resource
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import serendipity
from serendipity import pddl
from serendipity.model import Result, Task, UsageError
from serendipity.scenarios import generate_usar

PLANNING = 2.0
CALLS: dict[str, dict[str, Any]] = {
    "serendipity": {},
    "K = 0": {"window_weight": 0},
    "communication": {"mode": "communication"},
}
FIELDS = ("task", "actions", "call", "status", "limit", "verdict", "seconds", "processor", "own", "solver")


def main() -> None:
    """Measure and print a table."""
    arguments = _arguments()
    with TemporaryDirectory() as folder:
        tasks = [*_buildings(arguments.rooms, Path(folder)), *map(_named, arguments.tasks)]
        rows = []
        for name, words in tasks:
            for row in _rows(name, words, arguments.limit):
                rows.append(row)
                print(_line(row), flush=True)
    if arguments.csv is not None:
        with arguments.csv.open("w", newline="") as file:
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows(rows)
    for line in _summary(rows):
        print(line)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("tasks", nargs="*")
    parser.add_argument("--rooms", nargs="*", default=["2100,10", "840,2"])
    parser.add_argument("--limit", nargs="*", type=float, default=[0.05, 0.5, 2.0])
    parser.add_argument("--csv", type=Path, default=None)
    return parser.parse_args()


def _buildings(rooms: list[str], folder: Path) -> Iterator[tuple[str, list[str]]]:
    for text in rooms:
        size, medkits = map(int, text.split(","))
        path = folder / f"{size}-{medkits}"
        generate_usar(path, rooms=size, medkits=medkits, seed=1)
        yield f"{size} rooms, {medkits} medkits", [str(path), "commx"]


def _named(text: str) -> tuple[str, list[str]]:
    words = text.split(":")
    name = Path(words[0]).name if len(words) == 2 else f"{Path(words[0]).parent.name} {Path(words[1]).stem}"
    return name, words


def _rows(name: str, words: list[str], limits: list[float]) -> Iterator[dict[str, Any]]:
    for call, options in CALLS.items():
        data = _apart(_planned, words, options)
        for limit in limits if data is not None else ():
            about = {"task": name, "call": call, "status": data["status"], "limit": limit}
            yield about | _apart(_measured, words, data, limit)


def _apart(function: Any, *arguments: Any) -> Any:
    """Call a function in a new process: memory is a process's own."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


def _load(words: list[str]) -> Task:
    if len(words) == 2:
        return pddl.load(words[0], human=words[1])
    domain, problem, human, *robots = words
    return pddl.load_pddl(domain, problem, human=human, robots=robots)


def _planned(words: list[str], options: dict[str, Any]) -> dict[str, Any] | None:
    """An answer; None where the human has no plan and the mode needs a horizon then."""
    try:
        return serendipity.plan(_load(words), discount="0.9", time_limit=PLANNING, **options).to_dict()
    except UsageError:
        return None


def _measured(words: list[str], data: dict[str, Any], limit: float) -> dict[str, Any]:
    import highspy  # noqa: F401 - loading it is not what is measured

    import verify.certify  # noqa: F401

    task, result = _load(words), Result.from_dict(data)
    started, worked = perf_counter(), _processor()
    certificate = serendipity.verify(task, result, time_limit=limit)
    return {
        "actions": len(task.actions),
        "verdict": certificate.verdict,
        "seconds": perf_counter() - started,
        "processor": _processor() - worked,
        "own": _peak(resource.RUSAGE_SELF),
        "solver": _peak(resource.RUSAGE_CHILDREN),
    }


def _processor() -> float:
    """Seconds of processor time so far, those of finished children included."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _peak(who: int) -> float:
    """Most memory so far, in MiB."""
    return resource.getrusage(who).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)


def _line(row: dict[str, Any]) -> str:
    return (
        f"{row['task']:<28}{row['call']:<15}{row['status']:<11}{row['limit']:>5}{row['verdict']:>11}"
        f"{row['seconds']:>8.3f}{row['processor']:>8.3f}{row['own']:>7.0f}{row['solver']:>7.0f}"
    )


def _summary(rows: list[dict[str, Any]]) -> Iterator[str]:
    yield f"{'limit':>7}{'calls':>7}{'undecided':>11}{'overrun':>9}{'processor':>11}{'allowed':>9}{'MiB':>7}"
    for limit in sorted({row["limit"] for row in rows}):
        chosen = [row for row in rows if row["limit"] == limit]
        undecided = sum(row["verdict"] == "undecided" for row in chosen)
        over, worked = (max(row[key] for row in chosen) - limit for key in ("seconds", "processor"))
        memory = max(row["own"] + row["solver"] for row in chosen)
        yield (
            f"{limit:>7}{len(chosen):>7}{undecided:>11}{over:>9.3f}{worked:>11.3f}"
            f"{0.1 * limit + 0.05:>9.3f}{memory:>7.0f}"
        )


if __name__ == "__main__":
    main()
