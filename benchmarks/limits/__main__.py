"""How well every command keeps ``--time-limit`` and ``--memory-limit``, as a process.

    python -m benchmarks.limits plan|verify|memory|commands [--suite FOLDER] [--record FILE] [--jobs N]
        [--fair] [--limits 0.1,1,10] [--memory MIB] [--commands plan,...] [--rotate N] [--tasks NAME,...]
        [--stride N]

What is measured, unless options say otherwise:

- ``plan``: every mode on all tasks of the suite, limits of 0.1 and 1 s
- ``verify``: certificates for answers of every mode, on 100 tasks of all kinds, 0.05, 0.5 and 5 s
- ``memory``: every mode and ``verify`` on the ten largest tasks of the suite, 300 MiB, 20 s
- ``commands``: every command on ten tasks of the suite and four of our own, 0.05, 0.5 and 2 s; and on
  all of them 40 MiB above what the process has when it starts

Tasks are those of ``benchmarks.limits.tasks``; with ``--rotate`` each gets N of the commands, in turn.

A command starts when the interpreter and its modules are loaded, which it tells itself (``reproduce`` does
not, so the same command with a limit of 0 is taken off).  What is over the limit is the *overrun*; a limit
is *kept* if that is at most 10 % of it and 50 ms.  ``reproduce`` has the limit twice: for reading,
and for its row.  A process that is late by 15 s is killed.

On a busy machine the deadline also counts what others do.  With ``--fair`` no clock runs while the process
waits for a processor (on Linux).  It does not see what solvers wait for, which are processes of their own,
nor what the machine itself waits for another: rows that are late by little are worth a second look.

With ``--record`` rows are written as they come, and what is there already is not measured again; answers to
check are kept in a folder beside it.
"""

import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from string import Formatter
from typing import Literal, NamedTuple

import typer

from benchmarks.limits.process import Ended, Runner
from benchmarks.limits.tasks import Named, own_tasks, tasks_of_all_kinds, tasks_of_suite, with_files
from benchmarks.problems import PROBLEMS
from serendipity.evaluation.measuring.record import Record
from serendipity.evaluation.measuring.running import measured
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.model.telling import Grid, Line

MODES = {
    "plan": "plan {task} --discount 0.9",
    "plan individual": "plan {task} --mode individual",
    "plan K=0": "plan {task} --discount 0.9 --window-weight 0",
    "plan communication": "plan {task} --discount 0.9 --mode communication --format json",
    "plan composite": "plan {task} --discount 0.9 --mode composite --horizon inf",
    "plan local": "plan {task} --discount 0.9 --human-model local",
    "plan observant": "plan {task} --discount 0.9 --human-model observant",
    "plan ties": "plan {task} --discount 0.9 --ties robust --max-ties 1000000",
    "plan goals": "plan {task} --discount 0.9 --goals {goals}",
    "plan assistance": "plan {alone} --mode assistance",
}
"""By what the table calls them; each runs where its words can be filled in."""

CERTIFICATES = {
    "verify": "verify {task} {result}",
    "verify individual": "verify {task} {individual_result}",
    "verify K=0": "verify {task} {free_window_result}",
    "verify communication": "verify {task} {communication_result}",
    "verify composite": "verify {task} {composite_result}",
    "verify local": "verify {task} {local_result}",
    "verify ties": "verify {task} {ties_result}",
    "verify goals": "verify {task} {goals_result}",
    "verify assistance": "verify {alone} {assistance_result}",
}

OTHERS = {
    "individual verify": "plan {task} --mode individual --verify",
    "composite verify": "plan {task} --discount 0.9 --mode composite --horizon inf --verify",
    "plan verify": "plan {task} --discount 0.9 --verify",
    "assistance robust": "plan {alone} --mode assistance --ties robust --format json",
    "check-task": "check-task {task}",
    "explain": "explain {task} --discount 0.9",
    "interruptions": "interruptions {task} --discount 0.9 --format json",
    "recognise": "recognise {task} --goals {goals}",
    "simulate": "simulate {task} {result}",
    "solve": "solve {task} --discount 0.9",
    "reproduce": "reproduce {suite} --modes serendipity --discounts 0.9",
}

COMMANDS = MODES | CERTIFICATES | OTHERS


class Study(NamedTuple):
    """What is measured, unless options say otherwise.

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


STUDIES = {
    "plan": Study(MODES, "0.1,1"),
    "verify": Study(CERTIFICATES, "0.05,0.5,5"),
    "memory": Study(MODES | {"verify": CERTIFICATES["verify"]}, "", 300),
    "commands": Study(COMMANDS, "0.05,0.5,2", None, 8),
}

LARGEST = 10
"""Tasks that ``--memory`` is measured on."""

PATIENCE = 15.0
"""Seconds after which a late process is killed."""

ABOVE = 40
"""MiB that a process may add to what it has when it starts, where no limit on memory is named."""

CONFINED_FOR = 20.0
"""Seconds with a limit on memory."""

SHARE, EXTRA = 0.1, 0.05
"""What may be added to a limit: of it, and seconds."""

FOUND = (0, 3)
"""Exit codes of an answer, or a proof that there is none."""


@dataclass(frozen=True, slots=True)
class Job:
    """A command on a task under limits.

    Attributes:
        seconds: the limit on time.
        confined: whether there is one on memory, too, and of how many MiB (0: see ``ABOVE``).
    """

    command: str
    task: str
    line: tuple[str, ...]
    seconds: float
    confined: float | None
    runner: Runner


@dataclass(frozen=True, slots=True)
class Row:
    """What came of a job: exit code (None where it was killed), seconds over the limit, memory in MiB."""

    job: Job
    code: int | None
    over: float
    waited: float
    peak: float
    memory: float | None

    @property
    def beyond(self) -> float:
        """Seconds beyond what may be added to the limit."""
        return self.over - SHARE * self.job.seconds - EXTRA

    @property
    def kept(self) -> bool:
        """Whether the time limit was kept, and the process was not killed."""
        return self.code is not None and self.beyond <= 0

    @property
    def memory_over(self) -> float:
        """Share of the memory limit by which the peak is above it."""
        return 0.0 if self.memory is None else self.peak / self.memory - 1


def main(
    study: Literal["plan", "verify", "memory", "commands"],
    suite: Path = PROBLEMS / "codmap15",
    stride: int | None = None,
    tasks: str = "",
    commands: str = "",
    rotate: int | None = None,
    limits: str | None = None,
    memory: float | None = None,
    jobs: int = 1,
    fair: bool = False,
    record: Path | None = None,
) -> None:
    """Measure and print tables; exit code 1 where a limit was not kept."""
    usual = STUDIES[study]
    chosen = {name: COMMANDS[name] for name in commands.split(",")} if commands else usual.commands
    confined = usual.memory if memory is None else memory
    seconds = [float(limit) for limit in (usual.limits if limits is None else limits).split(",") if limit]
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch if record is None else record.absolute().with_suffix(".files"))
        folder.mkdir(parents=True, exist_ok=True)
        named = [*_tasks(study, suite, usual.stride if stride is None else stride, folder)]
        named = [task for task in named if task.name.startswith(tuple(tasks.split(",")))]
        if confined:
            named = sorted(named, key=lambda task: task.size)[-LARGEST:]
        under = [(limit, None) for limit in seconds] + (
            [] if confined == 0 else [(CONFINED_FOR, confined or 0.0)]
        )
        asked = [
            Job(name, task.name, tuple(line.split()), *limit, Runner(folder, fair))
            for turn, task in enumerate(named)
            for name, line in _lines(task, turn, chosen, rotate, folder)
            for limit in under
        ]
        print(f"{len(named)} tasks, {len(asked)} runs", file=sys.stderr, flush=True)
        rows = [Row(job, **found) for job, found in measured(asked, done, Record(record), processes=jobs)]
    print(as_markdown(_tables(rows)), end="")
    sys.exit(any(not row.kept or row.memory_over > SHARE for row in rows))


def _tasks(study: str, suite: Path, stride: int, folder: Path) -> Iterator[Named]:
    if study == "verify":
        yield from tasks_of_all_kinds(suite.parent, folder)
        return
    yield from own_tasks(folder) if study == "commands" else ()
    yield from tasks_of_suite(suite, stride)


def _lines(
    task: Named, turn: int, commands: dict[str, str], most: int | None, folder: Path
) -> Iterator[tuple[str, str]]:
    """Every command on a task where its words are known, or so many of them, in turn."""
    names = [*commands]
    number = len(names) if most is None else min(most, len(names))
    left = number
    for i in range(len(names)):
        name = names[(turn * number + i) % len(names)]
        words = {word for _, word, *_ in Formatter().parse(commands[name]) if word}
        task = with_files(task, words, folder)
        if left and task.words.keys() >= words:
            left -= 1
            yield name, commands[name].format(**task.words)
        if not left:
            return


def done(job: Job) -> dict[str, float | None]:
    """The fields of a row."""
    words, memory = [*job.line, "--time-limit", f"{job.seconds:g}"], None
    if job.confined is not None:
        memory = job.confined or round(_start(job.runner, job.line).peak + ABOVE)
        words += ["--memory-limit", f"{memory:g}"]
    allowed = job.seconds * (2 if job.command == "reproduce" else 1)
    ended = job.runner(words, allowed + PATIENCE)
    over = ended.seconds - allowed - (0.0 if ended.begun else _start(job.runner, job.line).seconds)
    return {"code": ended.code, "over": over, "waited": ended.waited, "peak": ended.peak, "memory": memory}


@cache
def _start(runner: Runner, line: tuple[str, ...]) -> Ended:
    """How a command starts, loads its modules, and ends at once."""
    return runner.started([*line], PATIENCE)


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
        over = f"{row.over * 1000:.0f} ms over, waited {row.waited * 1000:.0f} ms, {row.peak:.0f} MiB"
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
