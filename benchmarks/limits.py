"""Overruns of ``--time-limit`` and ``--memory-limit``, command by command, as processes.

    python -m benchmarks.limits plan|verify|memory [OPTIONS]

``plan``: every mode on all tasks of the suite, limits of 0.1 and 1 s.  ``verify``: certificates of answers of
every mode, 0.05, 0.5 and 5 s, on every third task of the suite, published buildings, generated ones, problems
of silent assistance, and what is shipped.  ``memory``: every mode and ``verify`` on the ten largest tasks of
the suite, 300 MiB and 20 s.  With ``--rotate`` each task gets N of the commands, in turn.

A command starts when the interpreter and its modules are loaded, which it tells itself.  What is over the
limit is the *overrun*; a limit is *kept* if that is at most 10 % of it and 50 ms.  A process that is late by
15 s is killed.  On a busy machine the deadline also counts what others do: rows that are late by little are
worth a second look.

Answers to check are kept in a folder beside ``--record``.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from threading import Timer
from typing import Final, Literal, NamedTuple

import serendipity
from benchmarks.problems import PROBLEMS, Record, run, silent, silent_task
from serendipity import Task
from serendipity.evaluation.measuring.record import apart, measured
from serendipity.evaluation.measuring.suites import folders, may_alone, problems, roles
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.model.telling import Grid, Line
from serendipity.scenarios.examples import EXAMPLES

MODES: Final = {
    "plan": "--discount 0.9",
    "plan individual": "--mode individual",
    "plan K=0": "--discount 0.9 --window-weight 0",
    "plan communication": "--discount 0.9 --mode communication --format json",
    "plan composite": "--discount 0.9 --mode composite --horizon inf",
    "plan local": "--discount 0.9 --human-model local",
    "plan observant": "--discount 0.9 --human-model observant",
    "plan ties": "--discount 0.9 --ties robust --max-ties 1000000",
    "plan goals": "--discount 0.9 --goals {goals}",
    "plan assistance": "--mode assistance",
}
"""Options of ``plan`` by what the table calls them; assistance is for a single robot."""

CERTIFICATES: Final = [mode.replace("plan", "verify") for mode in MODES]
"""Of the answer to each of these."""


class Study(NamedTuple):
    """Commands, and limits in seconds and MiB; ``largest``: how many of the suite's tasks, or all (None)."""

    commands: list[str]
    limits: str
    memory: float | None = None
    stride: int = 1
    largest: int | None = None


STUDIES: Final = {
    "plan": Study([*MODES], "0.1,1"),
    "verify": Study(CERTIFICATES, "0.05,0.5,5", stride=3),
    "memory": Study([*MODES, "verify"], "20", memory=300, largest=10),
}

ANSWERING: Final = 1.0
"""Seconds for an answer to check."""

FOUND: Final = (0, 3)
"""Exit codes of an answer, or a proof that there is none."""

PATIENCE: Final = 15.0
"""Seconds after which a late process is killed."""

SHARE, EXTRA = 0.1, 0.05
"""Tolerance: a share of the limit, and seconds."""

_BUILDINGS: Final = (
    *((21, 2, 1), (42, 2, 1), (42, 4, 2), (84, 2, 1), (84, 4, 3)),
    *((210, 2, 1), (210, 10, 1), (420, 2, 3), (840, 2, 1), (2100, 10, 1)),
)
"""Rooms, medkits, robots."""

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


class Named(NamedTuple):
    """A task, its words on a command line, with one robot (empty: it has more), a file of goals to guess."""

    name: str
    words: str
    alone: str
    goals: Path


class Job(NamedTuple):
    """A command on a task under limits, in a folder."""

    command: str
    task: str
    line: str
    seconds: float
    memory: float | None
    folder: Path


class Row(NamedTuple):
    """Outcome of a job: exit code (None where it was killed), seconds over the limit, peak memory in MiB."""

    job: Job
    code: int | None
    over: float
    peak: float

    @property
    def beyond(self) -> float:
        """Seconds over the limit and a tenth of it."""
        return self.over - SHARE * self.job.seconds

    @property
    def kept(self) -> bool:
        """True if the time limit was kept, and the process was not killed."""
        return self.code is not None and self.beyond <= EXTRA

    @property
    def memory_over(self) -> float:
        """Share of the memory limit by which the peak is above it."""
        return 0.0 if self.job.memory is None else self.peak / self.job.memory - 1


def main(
    study: Literal["plan", "verify", "memory"],
    suite: Path = PROBLEMS / "codmap15",
    rotate: int | None = None,
    limits: str = "",
    jobs: int = 1,
    record: Record = None,
) -> None:
    """Measure and print tables; exit code 1 where a limit was not kept."""
    usual = STUDIES[study]
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch if record is None else record.absolute().with_suffix(".files"))
        folder.mkdir(parents=True, exist_ok=True)
        named = apart(_tasks, study, suite, folder)
        asked = [
            Job(name, task.name, line, float(limit), usual.memory, folder)
            for turn, task in enumerate(named)
            for name, line in _lines(task, turn, usual.commands, rotate or len(usual.commands))
            for limit in (limits or usual.limits).split(",")
        ]
        print(f"{len(named)} tasks, {len(asked)} runs", file=sys.stderr, flush=True)
        rows = [Row(job, *found) for job, found in measured(asked, done, record, processes=jobs)]
    print(as_markdown(_tables(rows)), end="")
    sys.exit(any(not row.kept or row.memory_over > SHARE for row in rows))


def _tasks(study: str, suite: Path, folder: Path) -> list[Named]:
    """The tasks of a study; some are written to a folder, as is what may be guessed of each."""
    found = []
    for problem in problems(suite, stride=STUDIES[study].stride):
        who = roles(problem, 2, may_alone)
        alone = f"{problem.domain_file} {problem.problem_file} --human {who.human} --robot {who.robots[0]}"
        words = alone + "".join(f" --robot {robot}" for robot in who.robots[1:])
        found.append((f"{problem.domain} {problem.name}", words, alone, problem.task(who)))
    if study == "verify":
        others = _others(suite, folder)
        found += [(name, words, words * (len(task.robots) < 2), task) for name, words, task in others]
    named, largest = [], STUDIES[study].largest
    if largest:
        found = sorted(found, key=lambda each: len(each[-1].actions))[-largest:]
    for name, words, alone, task in found:
        file = folder / f"{_slug(name)}-goals.json"
        goals = [{"goal": [task.facts[fact]]} for fact in sorted(task.goal.positive)[:3]]
        file.write_text(json.dumps(goals))
        named.append(Named(name, words, alone, file))
    return named


def _others(suite: Path, folder: Path) -> Iterator[tuple[str, str, Task]]:
    """Tasks of all kinds, with the words that name them."""
    for place in folders(suite.parent / "usar200", 10):
        yield f"usar {place.name}", str(place), serendipity.load(place)
    for rooms, medkits, robots in _BUILDINGS:
        place = folder / f"building{rooms}-{medkits}-{robots}"
        serendipity.generate_usar(place, rooms=rooms, medkits=medkits, robots=robots)
        yield f"{rooms} rooms, {medkits} medkits, {robots} robots", str(place), serendipity.load(place)
    for name, *files in islice(silent(suite.parent / "spa"), 0, 72, 6):
        pairs = zip(("prime", "supporter"), files, strict=True)
        words = "".join(f"--agent {who}={domain},{file} " for who, (domain, file) in pairs)
        yield f"spa {name}", f"{words}--human prime", silent_task(*files)
    for name in EXAMPLES:
        yield name, f"--example {name}", serendipity.example(name)


def _slug(name: str) -> str:
    return re.sub(r"\W+", "-", name)


def _lines(task: Named, turn: int, commands: list[str], most: int) -> Iterator[tuple[str, str]]:
    """So many of the commands that there are for a task, in turn."""
    first = turn * most % len(commands)
    lines = ((name, _line(task, name)) for name in (commands * 2)[first:][: len(commands)])
    yield from islice(((name, line) for name, line in lines if line is not None), most)


def _line(task: Named, name: str) -> str | None:
    """A command on a task, and on an answer where it is about one; None where there is none."""
    mode = name.replace("verify", "plan")
    words = task.alone if mode == "plan assistance" else task.words
    if not words:
        return None
    asked = f"plan {words} {MODES[mode].format(goals=task.goals)}"
    if name == mode:
        return asked
    file = task.goals.with_name(f"{_slug(f'{task.name} {mode}')}.json")
    if not file.exists():
        limited = [*asked.split(), "--time-limit", f"{ANSWERING:g}", "--quiet", "-o", str(file)]
        command = [sys.executable, "-m", "serendipity", *limited]
        if subprocess.run(command, capture_output=True, check=False).returncode not in FOUND:
            file.write_text("")
    return f"verify {words} {file}" if file.stat().st_size else None


def done(job: Job) -> tuple[int | None, float, float]:
    """The fields of a row behind the job."""
    words = [*job.line.split(), "--time-limit", f"{job.seconds:g}", "--quiet"]
    words += [] if job.memory is None else ["--memory-limit", f"{job.memory:g}"]
    with tempfile.NamedTemporaryFile(mode="r", dir=job.folder) as said:
        process = subprocess.Popen(
            [sys.executable, "-c", _PROGRAM, said.name, *words],
            cwd=job.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        late = Timer(job.seconds + PATIENCE, process.kill)
        late.start()
        _, status, used = os.wait4(process.pid, 0)
        ended = time.perf_counter()
        late.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        began = float(said.read() or ended)
    code = None if process.returncode < 0 else process.returncode
    return code, ended - began - job.seconds, used.ru_maxrss / 1024


def _tables(rows: Sequence[Row]) -> Iterator[Line | Grid]:
    def latest(of: Sequence[Row]) -> str:
        worst = max(of, key=lambda row: row.over)
        return f"{'killed' if worst.code is None else f'{worst.over * 1000:.0f} ms'}, {worst.job.task}"

    def largest(of: Sequence[Row]) -> str:
        worst = max(of, key=lambda row: row.peak)
        return f"{worst.peak:.0f}, {worst.job.task}"

    columns = {
        "runs": len,
        "kept": lambda of: sum(row.kept for row in of),
        "with answer": lambda of: sum(row.code in FOUND for row in of),
        "most over": latest,
        "most MiB": largest,
    }
    yield table(
        ("command", "limit"), grouped(rows, lambda row: (row.job.command, f"{row.job.seconds:g} s")), columns
    )
    for row in rows:  # 2: a horizon is missing where the human has no plan alone
        if not row.kept or row.code not in (*FOUND, 4):
            job, kept = row.job, "exit" if row.kept else "not kept, exit"
            over = f"{row.over * 1000:.0f} ms over, {row.peak:.0f} MiB"
            yield Line(f"{job.command}, {job.task}, {job.seconds:g} s: {kept} {row.code}, {over}")
    within = sum(row.memory_over <= SHARE for row in rows)
    yield Line(
        f"Time: kept {sum(row.kept for row in rows)} of {len(rows)}, longest over 110 % of its limit "
        f"{max((row.beyond for row in rows), default=0) * 1000:.0f} ms; memory: within 110 % of a limit "
        f"{within} of {len(rows)}, highest peak {max((row.peak for row in rows), default=0):.0f} MiB."
    )


if __name__ == "__main__":
    run(main, __doc__)
