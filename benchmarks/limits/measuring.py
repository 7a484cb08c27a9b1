"""Commands on tasks, run under limits."""

import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from string import Formatter
from threading import Lock
from typing import NamedTuple

from benchmarks.limits.process import Ended, Runner
from benchmarks.limits.rows import Row
from benchmarks.limits.tasks import Named, with_files

PATIENCE = 15.0
"""Seconds after which a late process is killed."""

ABOVE = 40
"""MiB that a process may add to what it has when it starts."""

CONFINED_FOR = 20.0
"""Seconds with a limit on memory."""

READ_FIRST = ("reproduce",)
"""Commands whose limit holds for reading, and then again."""


class Job(NamedTuple):
    """One command on one task: what they are called, and the command line."""

    command: str
    task: str
    line: list[str]


def _words(command: str) -> set[str]:
    return {word for _, word, *_ in Formatter().parse(command) if word}


def jobs_of(task: Named, turn: int, commands: dict[str, str], most: int | None, folder: Path) -> list[Job]:
    """Every command on a task where its words are known, or so many of them, in turn."""
    number = len(commands) if most is None else min(most, len(commands))
    names = [*commands]
    names = [names[(turn * number + i) % len(names)] for i in range(len(names))]
    found: list[Job] = []
    while names and len(found) < number:
        some, names = names[: number - len(found)], names[number - len(found) :]
        task = with_files(task, set().union(*(_words(commands[name]) for name in some)), folder)
        found += [
            Job(name, task.name, commands[name].format(**task.words).split())
            for name in some
            if task.words.keys() >= _words(commands[name])
        ]
    return found


class Measuring:
    """Runs commands under limits.

    Args:
        run: runs them.
        seconds: limits on time.
        memory: MiB; None for little, above what a process starts with; 0 for no limit on memory.
    """

    def __init__(self, run: Runner, seconds: list[float], memory: float | None) -> None:
        self._run, self._seconds, self._memory = run, seconds, memory
        self._started: dict[str, Ended] = {}
        self._starting = Lock()

    def __call__(self, job: Job, known: set[tuple[object, ...]]) -> list[Row]:
        """Rows of one command on one task, those that are known left out."""
        wanted = [seconds for seconds in self._seconds if (job.command, job.task, seconds, None) not in known]
        rows = [self._limited(job, seconds) for seconds in wanted]
        late = any(row.code is None for row in rows)
        if self._memory != 0 and not late:
            most = self._memory or round(self._start(job).peak + ABOVE)
            if (job.command, job.task, CONFINED_FOR, most) not in known:
                rows.append(self._limited(job, CONFINED_FOR, most))
        return rows

    def _start(self, job: Job) -> Ended:
        with self._starting:
            if job.command not in self._started:
                self._started[job.command] = self._run.started(job.line, PATIENCE)
            return self._started[job.command]

    def _limited(self, job: Job, seconds: float, memory: float | None = None) -> Row:
        words = [*job.line, "--time-limit", f"{seconds:g}"]
        if memory is not None:
            words += ["--memory-limit", f"{memory:g}"]
        allowed = seconds * (2 if job.command in READ_FIRST else 1)
        ended = self._run(words, allowed + PATIENCE)
        over = ended.seconds - allowed - (0.0 if ended.begun else self._start(job).seconds)
        return Row(job.command, job.task, seconds, memory, ended.code, over, ended.waited, ended.peak)


def measured(
    measuring: Measuring, jobs: list[Job], known: set[tuple[object, ...]], processes: int
) -> Iterator[list[Row]]:
    """The rows of each job that are not known, as they come.

    Args:
        measuring: runs them.
        jobs: what to run.
        known: keys of rows that are there already.
        processes: how many at a time.
    """
    with ThreadPoolExecutor(processes) as threads:
        for number, new in enumerate(threads.map(lambda job: measuring(job, known), jobs), start=1):
            yield new
            if number % 50 == 0:
                print(f"{number} of {len(jobs)}", file=sys.stderr, flush=True)
