"""How well every command keeps ``--time-limit`` and ``--memory-limit``, as a process.

    python -m benchmarks.limits plan|verify|memory|commands [--suite FOLDER] [--csv FILE] [--jobs N] [--fair]
        [--limits 0.1,1,10] [--memory MIB] [--commands plan,...] [--rotate N] [--tasks NAME,...] [--stride N]

What is measured, unless options say otherwise:

- ``plan``: every mode on all tasks of the suite, limits of 0.1 and 1 s
- ``verify``: certificates for answers of every mode, on 100 tasks of all kinds, 0.05, 0.5 and 5 s
- ``memory``: every mode and ``verify`` on the ten largest tasks of the suite, 300 MiB, 20 s
- ``commands``: every command on ten tasks of the suite and four of our own, 0.05, 0.5 and 2 s; and on
  all of them 40 MiB above what the process has when it starts

Tasks are those of ``benchmarks.limit_tasks``.

A command starts when the interpreter and its modules are loaded, which it tells itself (``reproduce`` does
not, so the same command with a limit of 0 is taken off).  What is over the limit is the *overrun*; a limit
is *kept* if that is at most 10 % of it and 50 ms.  ``reproduce`` has the limit twice: for reading,
and for its row.  A process that is late by 15 s is killed.

On a busy machine the deadline also counts what others do.  With ``--fair`` no clock runs while the process
waits for a processor (on Linux).

With ``--csv`` rows are written as they come, and what is there already is not measured again; answers to
check are kept in a folder beside it.
"""

import argparse
import csv
import sys
import tempfile
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import astuple, dataclass, fields
from functools import partial
from itertools import count
from pathlib import Path
from string import Formatter
from threading import Lock
from typing import NamedTuple

from benchmarks.limit_kinds import tasks_of_all_kinds
from benchmarks.limit_tasks import Named, own_tasks, tasks_of_suite, with_files
from benchmarks.limited_process import Ended, Runner
from benchmarks.problems import PROBLEMS

SHARE, EXTRA = 0.1, 0.05
"""What may be added to a limit: of it, and seconds."""

PATIENCE = 15.0
"""Seconds after which a late process is killed."""

ABOVE = 40
"""MiB that a process may add to what it has when it starts."""

LARGEST = 10
"""Tasks that ``--memory`` is measured on."""

CONFINED_FOR = 20.0
"""Seconds with a limit on memory."""

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

READ_FIRST = ("reproduce",)
"""Commands whose limit holds for reading, and then again."""

FOUND = (0, 3)
"""Exit codes of an answer, or a proof that there is none."""


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


@dataclass(frozen=True, slots=True)
class Row:
    """One command on one task.

    Attributes:
        time_limit: seconds.
        memory_limit: MiB, or None.
        code: exit code; None where it was killed.
        over: seconds over the time limit.
        waited: seconds that the process waited for a processor.
        peak: most memory, in MiB.
    """

    command: str
    task: str
    time_limit: float
    memory_limit: float | None
    code: int | None
    over: float
    waited: float
    peak: float

    @classmethod
    def read(cls, cells: dict[str, str]) -> "Row":
        """A row as it was written."""
        numbers = [None if cells[field.name] == "" else float(cells[field.name]) for field in fields(cls)[2:]]
        row = cls(cells["command"], cells["task"], *numbers)  # type: ignore[arg-type]
        return row if row.code is None else cls(*astuple(row)[:4], int(row.code), *astuple(row)[5:])

    @property
    def kept(self) -> bool:
        """Whether the time limit was kept."""
        return self.beyond <= 0

    @property
    def beyond(self) -> float:
        """Seconds beyond what may be added to the limit."""
        return self.over - SHARE * self.time_limit - EXTRA

    @property
    def answered(self) -> bool:
        """Whether there was an answer, or a proof that there is none."""
        return self.code in FOUND

    @property
    def memory_over(self) -> float:
        """Share of the memory limit by which the peak is above it."""
        return 0.0 if self.memory_limit is None else self.peak / self.memory_limit - 1


def main() -> int:
    """Measure and print tables; 1 where a limit was not kept."""
    arguments = _arguments()
    study = STUDIES[arguments.study]
    commands = study.commands
    if arguments.commands:
        commands = {name: COMMANDS[name] for name in arguments.commands.split(",")}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch if arguments.csv is None else arguments.csv.absolute().with_suffix(".files"))
        folder.mkdir(parents=True, exist_ok=True)
        tasks = [task for task in _tasks(arguments, folder) if task.name.startswith(arguments.tasks)]
        limits = study.limits if arguments.limits is None else arguments.limits
        memory = study.memory if arguments.memory is None else arguments.memory
        if memory:
            tasks = sorted(tasks, key=lambda task: task.size)[-LARGEST:]
        print(f"{len(tasks)} tasks, {len(commands)} commands", file=sys.stderr, flush=True)
        choose = partial(_jobs, commands=commands, most=arguments.rotate, folder=folder)
        with ThreadPoolExecutor(arguments.jobs) as threads:
            jobs = [job for found in threads.map(choose, tasks, count()) for job in found]
        print(f"{len(jobs)} commands on tasks", file=sys.stderr, flush=True)
        seconds = [float(limit) for limit in limits.split(",") if limit]
        measuring = Measuring(Runner(folder, arguments.fair), seconds, memory)
        rows = _measured(measuring, jobs, arguments.csv, arguments.jobs)
    _table_of_times(rows)
    _table_of_memory(rows)
    return _summary(rows)


def _tasks(arguments: argparse.Namespace, folder: Path) -> list[Named]:
    if arguments.study == "verify":
        return [*tasks_of_all_kinds(arguments.suite.parent, folder)]
    stride = STUDIES[arguments.study].stride if arguments.stride is None else arguments.stride
    own = own_tasks(folder) if arguments.study == "commands" else ()
    return [*own, *tasks_of_suite(arguments.suite, stride)]


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("study", choices=STUDIES)
    parser.add_argument(
        "--suite", type=Path, default=PROBLEMS / "codmap15", help="folder of domains in MA-PDDL"
    )
    parser.add_argument("--stride", type=int, default=None, help="take every N-th task of each domain")
    parser.add_argument("--tasks", type=_names, default=("",), help="only tasks whose names begin so")
    parser.add_argument("--commands", default="", help="some of the table's commands")
    parser.add_argument(
        "--rotate", type=int, default=None, help="on each task only N of the commands, in turn"
    )
    parser.add_argument("--limits", default=None, help="seconds, or none")
    parser.add_argument("--memory", type=float, default=None, help="MiB, on the ten largest tasks; 0: none")
    parser.add_argument("--jobs", type=int, default=1, help="so many processes at a time")
    parser.add_argument(
        "--fair", action="store_true", help="don't count what a process waits for a processor"
    )
    parser.add_argument("--csv", type=Path, default=None, help="write rows here, and go on where it ends")
    return parser.parse_args()


def _names(text: str) -> tuple[str, ...]:
    return tuple(text.split(","))


# -- processes


class Job(NamedTuple):
    """One command on one task: what they are called, and the command line."""

    command: str
    task: str
    line: list[str]


def _words(command: str) -> set[str]:
    return {word for _, word, *_ in Formatter().parse(command) if word}


def _jobs(task: Named, turn: int, commands: dict[str, str], most: int | None, folder: Path) -> list[Job]:
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

    def __call__(self, job: Job, known: dict[tuple[object, ...], Row]) -> list[Row]:
        """Rows of one command on one task, those that are known left out."""
        rows = [
            self._timed(job, limit)
            for limit in self._seconds
            if (job.command, job.task, limit, None) not in known
        ]
        late = any(row.code is None for row in rows)
        if self._memory != 0 and not late:
            most = self._memory or round(self._start(job).peak + ABOVE)
            if (job.command, job.task, CONFINED_FOR, most) not in known:
                rows.append(self._confined(job, most))
        return rows

    def _start(self, job: Job) -> Ended:
        with self._starting:
            if job.command not in self._started:
                self._started[job.command] = self._run.started(job.line, PATIENCE)
            return self._started[job.command]

    def _timed(self, job: Job, limit: float) -> Row:
        allowed = limit * (2 if job.command in READ_FIRST else 1)
        ended = self._run([*job.line, "--time-limit", f"{limit:g}"], self._patience(allowed))
        over = ended.seconds - allowed - (0.0 if ended.begun else self._start(job).seconds)
        return Row(job.command, job.task, limit, None, ended.code, over, ended.waited, ended.peak)

    def _patience(self, limit: float) -> float:
        return limit * (10 if self._run.fair else 1) + PATIENCE

    def _confined(self, job: Job, most: float) -> Row:
        words = [*job.line, "--time-limit", f"{CONFINED_FOR:g}", "--memory-limit", f"{most:g}"]
        ended = self._run(words, self._patience(CONFINED_FOR))
        return Row(job.command, job.task, CONFINED_FOR, most, ended.code, 0.0, ended.waited, ended.peak)


def _measured(measuring: Measuring, jobs: list[Job], file: Path | None, processes: int) -> list[Row]:
    """All rows, each in the file at once; those that the file has are taken from it."""
    header = [field.name for field in fields(Row)]
    known = {}
    if file is not None and file.exists():
        with file.open(newline="", encoding="utf-8") as text:
            known = {
                (r.command, r.task, r.time_limit, r.memory_limit): r
                for r in map(Row.read, csv.DictReader(text))
            }
    elif file is not None:
        file.write_text(",".join(header) + "\n", encoding="utf-8")
    rows = [*known.values()]
    with ThreadPoolExecutor(processes) as threads:
        for number, new in enumerate(threads.map(lambda job: measuring(job, known), jobs), start=1):
            rows += new
            if new and file is not None:
                with file.open("a", newline="", encoding="utf-8") as text:
                    csv.writer(text).writerows(map(astuple, new))
            if number % 50 == 0:
                print(f"{number} of {len(jobs)}", file=sys.stderr, flush=True)
    return rows


# -- tables


def _table_of_times(rows: list[Row]) -> None:
    timed = [row for row in rows if row.memory_limit is None]
    if timed:
        print(f"{'command':21}{'limit':>6}{'runs':>6}{'kept':>6}{'with answer':>13}   most over, ms")
    for command, limit in dict.fromkeys((row.command, row.time_limit) for row in timed):
        members = [row for row in timed if (row.command, row.time_limit) == (command, limit)]
        worst = max(members, key=lambda row: row.over)
        shown = "killed" if worst.code is None else f"{worst.over * 1000:.0f}"
        counts = f"{len(members):>6}{_count(row.kept for row in members):>6}"
        counts += f"{_count(row.answered for row in members):>13}"
        print(f"{command:21}{limit:>4g} s{counts}   {shown}, {worst.task}")
    for row in rows:  # 2: a horizon is missing where the human has no plan alone
        if row.code not in (*FOUND, 4, None):
            print(f"exit {row.code}: {row.command}, {row.task}, {row.time_limit:g} s")
    late = sorted((row for row in timed if not row.kept), key=lambda row: -row.beyond)
    for row in late:
        over = f"{row.over * 1000:.0f} ms over, waited {row.waited * 1000:.0f} ms, exit {row.code}"
        print(f"not kept: {row.command}, {row.task}, {row.time_limit:g} s: {over}, {row.peak:.0f} MiB")


def _table_of_memory(rows: list[Row]) -> None:
    confined = [row for row in rows if row.memory_limit is not None]
    if confined:
        print(f"\n{'command':21}{'runs':>6}{'with answer':>13}   highest peak, of the memory limit")
    for command in dict.fromkeys(row.command for row in confined):
        members = [row for row in confined if row.command == command]
        worst = max(members, key=lambda row: row.memory_over)
        shown = f"{worst.memory_over:+.0%} ({worst.peak:.0f} of {worst.memory_limit:.0f} MiB), {worst.task}"
        answered = _count(row.answered for row in members)
        print(f"{command:21}{len(members):>6}{answered:>13}   {shown}, exit {worst.code}")
        unanswered = ", ".join(row.task for row in members if not row.answered)
        if unanswered:
            print(f"{'':21}without: {unanswered}")


def _summary(rows: list[Row]) -> int:
    """The last lines; 1 where a limit was not kept."""
    timed = [row for row in rows if row.memory_limit is None]
    confined = [row for row in rows if row.memory_limit is not None]
    kept = _count(row.kept for row in timed)
    within = _count(row.memory_over <= SHARE for row in confined)
    print()
    if timed:
        longest = max(row.beyond + EXTRA for row in timed) * 1000
        print(
            f"time: kept {kept} of {len(timed)}, longest over 110 % of its limit {longest:.0f} ms, "
            f"highest peak {max(row.peak for row in timed):.0f} MiB"
        )
    if confined:
        worst = max(row.peak for row in confined)
        answered = _count(row.answered for row in confined)
        print(
            f"memory: within 110 % of the limit {within} of {len(confined)}, "
            f"highest peak {worst:.0f} MiB, with answer {answered}"
        )
    return int(kept < len(timed) or within < len(confined))


def _count(flags: Iterable[bool]) -> int:
    return sum(flags)


if __name__ == "__main__":
    sys.exit(main())
