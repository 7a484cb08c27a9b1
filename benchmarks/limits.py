"""Overruns of ``--time-limit`` and ``--memory-limit``, command by command, as processes.

    python -m benchmarks.limits plan|verify|memory|commands [--suite FOLDER] [--record FILE] [--jobs N]
        [--limits 0.1,1,10] [--memory MIB] [--rotate N] [--stride N]

What is measured, unless options say otherwise:

- ``plan``: every mode on all tasks of the suite, limits of 0.1 and 1 s
- ``verify``: certificates for answers of every mode, on some 80 tasks of all kinds, 0.05, 0.5 and 5 s
- ``memory``: every mode and ``verify`` on the ten largest tasks of the suite, 300 MiB, 20 s
- ``commands``: every command on ten tasks of the suite and four of our own, 0.05, 0.5 and 2 s; and on
  all of them 40 MiB above what the process has when it starts

Commands and tasks are those of ``benchmarks.limited_tasks``; with ``--rotate`` each task gets N of the
commands, in turn.

A command starts when the interpreter and its modules are loaded, which it tells itself.  What is over the
limit is the *overrun*; a limit is *kept* if that is at most 10 % of it and 50 ms.  A process that is late by
15 s is killed.  On a busy machine the deadline also counts what others do: rows that are late by little are
worth a second look.

With ``--record`` rows are written as they come, and what is there already is not measured again; answers to
check are kept in a folder beside it.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import Timer
from typing import Final, Literal, NamedTuple

import typer

from benchmarks.limited_tasks import CERTIFICATES, FOUND, MODES, OTHERS, lines, tasks
from benchmarks.problems import PROBLEMS
from serendipity.evaluation.measuring.record import Record
from serendipity.evaluation.measuring.running import measured
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.model.telling import Grid, Line


class Study(NamedTuple):
    """Commands and limits of a study, unless options say otherwise.

    Attributes:
        commands: by what the table calls them.
        limits: seconds.
        memory: MiB for the ten largest tasks; None for little, and all of them; 0 for none.
        stride: take every N-th task of each domain of the suite.
    """

    commands: dict[str, str]
    limits: str
    memory: float | None = 0
    stride: int = 1


STUDIES: Final = {
    "plan": Study(MODES, "0.1,1"),
    "verify": Study(CERTIFICATES, "0.05,0.5,5", stride=3),
    "memory": Study(MODES | {"verify": CERTIFICATES["verify"]}, "", 300),
    "commands": Study(MODES | CERTIFICATES | OTHERS, "0.05,0.5,2", None, 8),
}

LARGEST: Final = 10
"""Tasks that ``--memory`` is measured on."""

PATIENCE: Final = 15.0
"""Seconds after which a late process is killed."""

ABOVE: Final = 40
"""MiB that a process may add to what it has when it starts, where no limit on memory is named."""

CONFINED_FOR: Final = 20.0
"""Seconds with a limit on memory."""

SHARE, EXTRA = 0.1, 0.05
"""Tolerance: a share of the limit, and seconds."""

_PROGRAM: Final = """
import runpy, sys, time
from serendipity.cli.options import limits

said, begin = sys.argv.pop(1), limits.limits_from

def begun(*given):
    with open(said, "w") as file:
        print(time.perf_counter(), file=file)
    return begin(*given)

limits.limits_from = begun
runpy.run_module("serendipity", None, "__main__")
"""
"""The command ``serendipity``, which tells when its limits begin."""


@dataclass(frozen=True, slots=True)
class Job:
    """A command on a task under limits.

    Attributes:
        seconds: the limit on time.
        confined: MiB where there is a limit on memory, too (0: see ``ABOVE``).
        folder: where it runs.
    """

    command: str
    task: str
    line: tuple[str, ...]
    seconds: float
    confined: float | None
    folder: Path


@dataclass(frozen=True, slots=True)
class Row:
    """Outcome of a job: exit code (None where it was killed), seconds over the limit, memory in MiB."""

    job: Job
    code: int | None
    over: float
    peak: float
    memory: float | None

    @property
    def beyond(self) -> float:
        """Seconds beyond what may be added to the limit."""
        return self.over - SHARE * self.job.seconds - EXTRA

    @property
    def kept(self) -> bool:
        """True if the time limit was kept, and the process was not killed."""
        return self.code is not None and self.beyond <= 0

    @property
    def memory_over(self) -> float:
        """Share of the memory limit by which the peak is above it."""
        return 0.0 if self.memory is None else self.peak / self.memory - 1


def main(
    study: Literal["plan", "verify", "memory", "commands"],
    suite: Path = PROBLEMS / "codmap15",
    stride: int | None = None,
    rotate: int | None = None,
    limits: str | None = None,
    memory: float | None = None,
    jobs: int = 1,
    record: Path | None = None,
) -> None:
    """Measure and print tables; exit code 1 where a limit was not kept."""
    usual = STUDIES[study]
    confined = usual.memory if memory is None else memory
    under: list[tuple[float, float | None]] = [
        (float(limit), None) for limit in (usual.limits if limits is None else limits).split(",") if limit
    ]
    under += [] if confined == 0 else [(CONFINED_FOR, confined or 0.0)]
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch if record is None else record.absolute().with_suffix(".files"))
        folder.mkdir(parents=True, exist_ok=True)
        named = [*tasks(study, suite, usual.stride if stride is None else stride, folder)]
        if confined:
            named = sorted(named, key=lambda task: task.size)[-LARGEST:]
        asked = [
            Job(name, task.name, tuple(line.split()), *limit, folder)
            for turn, task in enumerate(named)
            for name, line in lines(task, turn, usual.commands, rotate, folder)
            for limit in under
        ]
        print(f"{len(named)} tasks, {len(asked)} runs", file=sys.stderr, flush=True)
        rows = [Row(job, **found) for job, found in measured(asked, done, Record(record), processes=jobs)]
    print(as_markdown(_tables(rows)), end="")
    sys.exit(any(not row.kept or row.memory_over > SHARE for row in rows))


def done(job: Job) -> dict[str, float | None]:
    """The fields of a row."""
    words, memory = [*job.line, "--time-limit", f"{job.seconds:g}"], None
    if job.confined is not None:
        memory = job.confined or round(_at_start(job.folder, job.line) + ABOVE)
        words += ["--memory-limit", f"{memory:g}"]
    code, seconds, peak = _ended(job.folder, words, job.seconds + PATIENCE)
    return {"code": code, "over": seconds - job.seconds, "peak": peak, "memory": memory}


@cache
def _at_start(folder: Path, line: tuple[str, ...]) -> float:
    """Peak memory, in MiB, of a command that starts, loads its modules, and ends at once."""
    return _ended(folder, [*line, "--time-limit", "0"], PATIENCE)[-1]


def _ended(folder: Path, words: Sequence[str], patience: float) -> tuple[int | None, float, float]:
    """The end of a command, which is killed after some seconds.

    Returns:
        Its exit code, None where it was killed; seconds since its limits began; most memory in MiB.
    """
    with tempfile.NamedTemporaryFile(mode="r", dir=folder) as said:
        process = subprocess.Popen(
            [sys.executable, "-c", _PROGRAM, said.name, *words, "--quiet"],
            cwd=folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        late = Timer(patience, process.kill)
        late.start()
        _, status, used = os.wait4(process.pid, 0)
        ended = time.perf_counter()
        late.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        began = float(said.read() or ended)
    code = None if process.returncode < 0 else process.returncode
    return code, ended - began, used.ru_maxrss / 1024


def _tables(rows: Sequence[Row]) -> Iterator[Line | Grid]:
    timed, confined = ([row for row in rows if (row.memory is None) is without] for without in (True, False))

    def answered(of: Sequence[Row]) -> int:
        return sum(row.code in FOUND for row in of)

    def latest(of: Sequence[Row]) -> str:
        worst = max(of, key=lambda row: row.over)
        return f"{'killed' if worst.code is None else f'{worst.over * 1000:.0f} ms'}, {worst.job.task}"

    def largest(of: Sequence[Row]) -> str:
        worst = max(of, key=lambda row: row.memory_over)
        return f"{worst.memory_over:+.0%} ({worst.peak:.0f} of {worst.memory:.0f} MiB), {worst.job.task}"

    counts = {"runs": len, "kept": lambda of: sum(row.kept for row in of), "with answer": answered}
    by_limit = grouped(timed, lambda row: (row.job.command, f"{row.job.seconds:g} s"))
    yield table(("command", "limit"), by_limit, counts | {"most over": latest})
    for row in rows:  # 2: a horizon is missing where the human has no plan alone
        over = f"{row.over * 1000:.0f} ms over, {row.peak:.0f} MiB"
        if not row.kept or row.code not in (*FOUND, 4):
            kept = "exit" if row.kept else "not kept, exit"
            yield Line(f"{row.job.command}, {row.job.task}, {row.job.seconds:g} s: {kept} {row.code}, {over}")
    if confined:
        by_command = grouped(confined, lambda row: (row.job.command,))
        yield table(("command",), by_command, counts | {"highest peak, of the memory limit": largest})
    within = sum(row.memory_over <= SHARE for row in confined)
    yield Line(
        f"Time: kept {sum(row.kept for row in rows)} of {len(rows)}, longest over 110 % of its limit "
        f"{max((row.beyond + EXTRA for row in rows), default=0) * 1000:.0f} ms; "
        f"memory: within 110 % of the limit {within} of {len(confined)}, "
        f"highest peak {max((row.peak for row in rows), default=0):.0f} MiB."
    )


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
