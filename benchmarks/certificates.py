"""Time of a certificate, parse to verdict, over a folder of tasks (one thread).

    python -m benchmarks.certificates FOLDER [--encoding automata] [--solver highs] [--method auto]
        [--stride N] [--limit N] [--mode MODE] [--discount D] [--time-limit SECONDS] [--csv FILE]

Each task is read, planned, read again and verified; only the second reading and the
verification are timed.  The table is in seconds of processor time, the solver's included, which
other work on the machine leaves as it is; the rows have the deadline's seconds too, which
``--time-limit`` is about.  With ``--csv`` the rows are appended and a later run with the same
file goes on where the first one stopped.
"""

import argparse
import csv
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

import serendipity
from serendipity.model import Result
from verify.certificate.certify import certify
from verify.programs.effort import METHODS

KEY = ("test", "mode", "discount", "encoding", "solver", "method")
FIELDS = (*KEY, "verdict", "processor", "seconds", "load", "variables", "constraints", "calls")
MODES = ("serendipity", "communication")
DISCOUNTS = ("0", "0.5", "0.9")


def main() -> None:
    """Measure and print a table."""
    arguments = _arguments()
    done = _read(arguments.csv)
    rows = list(done.values())
    for folder in folders(arguments):
        for mode in arguments.mode or MODES:
            for discount in arguments.discount or DISCOUNTS:
                key = (folder.name, mode, discount, *_settings(arguments))
                if key not in done:
                    row = _measure(folder, mode, discount, arguments)
                    rows.append(row)
                    append(arguments.csv, row)
    settings = _settings(arguments)
    _table([row for row in rows if tuple(row[name] for name in KEY[-3:]) == settings])


def _settings(arguments: argparse.Namespace) -> tuple[str, str, str]:
    return arguments.encoding, arguments.solver, arguments.method


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--human", default=None)
    parser.add_argument("--encoding", default="automata", choices=("automata", "paper"))
    parser.add_argument("--solver", default="highs", choices=("highs", "cbc"))
    parser.add_argument("--method", default="auto", choices=METHODS)
    parser.add_argument("--stride", type=int, default=1, help="every N-th task")
    parser.add_argument("--limit", type=int, default=None, help="at most N tasks")
    parser.add_argument("--mode", action="append", choices=MODES, help="these modes only")
    parser.add_argument("--discount", action="append", choices=DISCOUNTS, help="these discounts only")
    parser.add_argument("--time-limit", type=float, default=None, help="seconds for a certificate")
    parser.add_argument("--csv", type=Path, default=None, help="append rows here, and resume from it")
    return parser.parse_args()


def folders(arguments: argparse.Namespace) -> list[Path]:
    """The tasks that are asked for: every ``stride``-th of ``folder``, ``limit`` at most."""
    found = sorted((p for p in arguments.folder.iterdir() if p.is_dir()), key=lambda p: (len(p.name), p.name))
    return found[:: arguments.stride][: arguments.limit]


def _measure(folder: Path, mode: str, discount: str, arguments: argparse.Namespace) -> dict[str, str]:
    task = serendipity.load(folder, human=arguments.human)
    planned = serendipity.plan(task, mode=mode, discount=discount)
    data = planned.to_dict()
    started, worked = perf_counter(), processor()
    task = serendipity.load(folder, human=arguments.human)
    loaded = perf_counter()
    certificate = certify(
        task,
        Result.from_dict(data),
        encoding=arguments.encoding,
        solver=arguments.solver,
        method=arguments.method,
        time_limit=arguments.time_limit,
    )
    seconds, spent = perf_counter() - started, processor() - worked
    return {
        "test": folder.name,
        "mode": mode,
        "discount": discount,
        "encoding": arguments.encoding,
        "solver": arguments.solver,
        "method": arguments.method,
        "verdict": certificate.verdict,
        "processor": f"{spent:.4f}",
        "seconds": f"{seconds:.4f}",
        "load": f"{loaded - started:.4f}",
        "variables": str(certificate.size.get("variables", 0)),
        "constraints": str(certificate.size.get("constraints", 0)),
        "calls": str(certificate.solver_calls),
    }


def processor() -> float:
    """Seconds of processor time so far, those of finished children (CBC is one) included."""
    times = os.times()
    return process_time() + times.children_user + times.children_system


def _read(path: Path | None) -> dict[tuple[str, ...], dict[str, str]]:
    if path is None or not path.exists():
        return {}
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {tuple(row[name] for name in KEY): row for row in rows}


def append(path: Path | None, row: dict[str, str], fields: Sequence[str] = FIELDS) -> None:
    """One more row of a CSV file, which begins with the names of its fields."""
    if path is None:
        return
    new = not path.exists()
    with path.open("a", newline="") as file:
        writer = csv.DictWriter(file, fields)
        if new:
            writer.writeheader()
        writer.writerow(row)


def _table(rows: list[dict[str, str]]) -> None:
    print(
        f"{'mode':<14}{'discount':>9}{'n':>5}{'proved':>8}{'undecided':>10}{'median':>9}{'95 %':>9}{'max':>9}"
        f"{'calls':>7}{'columns':>9}{'rows':>7}"
    )
    for line in _lines(rows):
        print(line)


def _lines(rows: list[dict[str, str]]) -> Iterator[str]:
    for mode in MODES:
        for discount in (*DISCOUNTS, "all"):
            chosen = [row for row in rows if row["mode"] == mode and discount in (row["discount"], "all")]
            if not chosen or (discount == "all" and len({row["discount"] for row in chosen}) < 2):
                continue
            times = sorted(float(row["processor"]) for row in chosen)
            verdicts = [row["verdict"] for row in chosen]
            worst = times[max(0, -(-len(times) * 95 // 100) - 1)]
            yield (
                f"{mode:<14}{discount:>9}{len(times):>5}{verdicts.count('proved'):>8}"
                f"{verdicts.count('undecided'):>10}{median(times):>8.3f}s{worst:>8.3f}s{times[-1]:>8.3f}s"
                f"{sum(int(row['calls']) for row in chosen):>7}"
                f"{median(int(row['variables']) for row in chosen):>9.0f}"
                f"{median(int(row['constraints']) for row in chosen):>7.0f}"
            )


if __name__ == "__main__":
    main()
