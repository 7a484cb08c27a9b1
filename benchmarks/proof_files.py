"""Proof files over a folder of tasks: written, their size, checked (one thread).

    python -m benchmarks.proof_files FOLDER [--human H] [--stride N] [--limit N] [--mode MODE] [--discount D]
        [--time-limit SECONDS] [--csv FILE]

Each task is planned and read again.  Then ``write`` is all of ``verify --proof``, reading included;
``check`` is the checker alone, from the file to its verdict, as in a process that has started; and
``compare`` is ``check-proof`` with task and result, which reads the task and makes the programs again.
Times are seconds of processor time, which other work on the machine leaves as it is.  With ``--csv``
the rows are appended, and a later run with the same file goes on where the first one stopped.
"""

import argparse
import csv
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

import serendipity
from benchmarks.certificates import DISCOUNTS, MODES, append, folders, processor
from serendipity.model import Result
from verify.proofs import checker

KEY = ("test", "mode", "discount")
FIGURES = ("write", "size", "check", "compare", "columns", "rows", "leaves")
FIELDS = (*KEY, "verdict", "checked", "compared", *FIGURES)


def main() -> None:
    """Measure and print a table."""
    arguments = _arguments()
    rows = _read(arguments.csv)
    done = {tuple(row[name] for name in KEY) for row in rows}
    chosen = folders(arguments)
    with TemporaryDirectory() as scratch:
        for folder in chosen:
            for mode in arguments.mode or MODES:
                for discount in arguments.discount or DISCOUNTS:
                    if (folder.name, mode, discount) not in done:
                        row = _measure(folder, mode, discount, Path(scratch), arguments)
                        rows.append(row)
                        append(arguments.csv, row, FIELDS)
    for line in _table(rows):
        print(line)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--human", default=None)
    parser.add_argument("--stride", type=int, default=1, help="every N-th task")
    parser.add_argument("--limit", type=int, default=None, help="at most N tasks")
    parser.add_argument("--mode", action="append", choices=MODES, help="these modes only")
    parser.add_argument("--discount", action="append", choices=DISCOUNTS, help="these discounts only")
    parser.add_argument("--time-limit", type=float, default=None, help="seconds for a proof")
    parser.add_argument("--csv", type=Path, default=None, help="append rows here, and resume from it")
    return parser.parse_args()


def _measure(
    folder: Path, mode: str, discount: str, scratch: Path, arguments: argparse.Namespace
) -> dict[str, str]:
    def load() -> serendipity.Task:
        return serendipity.load(folder, human=arguments.human)

    result = Result.from_dict(serendipity.plan(load(), mode=mode, discount=discount).to_dict())
    file = scratch / "proof.json.gz"
    file.unlink(missing_ok=True)
    limit = arguments.time_limit
    certificate, write = _timed(lambda: serendipity.verify(load(), result, proof=file, time_limit=limit))
    row = {"test": folder.name, "mode": mode, "discount": discount, "verdict": certificate.verdict}
    if not file.exists():
        return row | {"checked": "", "compared": "", "write": f"{write:.4f}"} | dict.fromkeys(FIGURES[1:], "")
    programs, check = _timed(lambda: checker.check(checker.read(file)))
    found, compare = _timed(lambda: serendipity.check_proof(file, load(), result))
    return row | {
        "checked": "holds",
        "compared": found.verdict,
        "write": f"{write:.4f}",
        "size": str(file.stat().st_size),
        "check": f"{check:.4f}",
        "compare": f"{compare:.4f}",
        "columns": str(max(program.columns for program in programs)),
        "rows": str(max(program.rows for program in programs)),
        "leaves": str(sum(program.leaves for program in programs)),
    }


def _timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """What work gives, and its seconds of processor time, those of finished children included."""
    started = processor()
    return work(), processor() - started


def _read(path: Path | None) -> list[dict[str, str]]:
    if path is None or not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _table(rows: list[dict[str, str]]) -> Iterator[str]:
    for mode in (*MODES, "all"):
        chosen = [row for row in rows if mode in (row["mode"], "all")]
        if not chosen:
            continue
        files = [row for row in chosen if row["size"]]
        accepted = sum(row["compared"] == "accepted" for row in files)
        yield f"{mode}: {len(chosen)} certificates, {len(files)} files, {accepted} accepted"
        yield f"  {'':<16}{'median':>10}{'95 %':>10}{'most':>10}"
        for name in FIGURES:
            values = sorted(float(row[name]) for row in files)
            if values:
                worst = values[max(0, -(-len(values) * 95 // 100) - 1)]
                figures = (median(values), worst, values[-1])
                unit = "KiB" if name == "size" else "s" if name in ("write", "check", "compare") else ""
                scale, digits = (1024, 1) if unit == "KiB" else (1, 3 if unit else 0)
                shown = "".join(f"{value / scale:>10.{digits}f}" for value in figures)
                yield f"  {f'{name} {unit}':<16}{shown}"


if __name__ == "__main__":
    main()
