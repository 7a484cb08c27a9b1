"""How well every command keeps ``--time-limit`` and ``--memory-limit``, as a process.

    python -m benchmarks.limits [--no-own] [--suite FOLDER [--stride N]] [--limits 0.1,1,10]
        [--memory MIB] [--commands plan,...] [--csv FILE] [--processor]

Tasks are those of ``benchmarks.limit_tasks``.

A command starts when the interpreter and its modules are loaded; how long that takes is measured
by the same command with a limit of 0, and taken off.  What is left over the limit is the *overrun*; a limit
is *kept* if that is at most 10 % of it and 50 ms.  ``reproduce`` has the limit twice: for reading,
and for its row.  A process that is late by 15 s is killed.  On a busy machine the deadline also counts what
others do: the overrun in processor time, told beside it, is at least what the process did too much.
With ``--processor`` deadlines are in processor time, solvers' processes apart, and only that is looked at.

Then the same with a limit on memory: 40 MiB above what the process has when it starts, on every
task, or ``--memory``, on the ten largest.  The table says how far the peak is above the limit, in
percent, and how many runs had an answer.
"""

import argparse
import csv
import os
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from string import Formatter
from typing import NamedTuple

from benchmarks.limit_tasks import Named, own_tasks, tasks_of_suite, with_files
from benchmarks.limited_process import PROCESSOR, USUAL, Ended, Runner

LIMITS = "0.05,0.5,2"
"""Seconds."""

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

COMMANDS = {
    "plan": "plan {task} --discount 0.9",
    "plan individual": "plan {task} --mode individual",
    "plan K=0": "plan {task} --discount 0.9 --window-weight 0",
    "plan communication": "plan {task} --discount 0.9 --mode communication --format json",
    "plan composite": "plan {task} --discount 0.9 --mode composite --horizon inf",
    "plan local": "plan {task} --discount 0.9 --human-model local",
    "plan ties": "plan {task} --discount 0.9 --ties robust --max-ties 1000000",
    "plan goals": "plan {task} --discount 0.9 --goals {goals}",
    "individual verify": "plan {task} --mode individual --verify",
    "composite verify": "plan {task} --discount 0.9 --mode composite --horizon inf --verify",
    "plan verify": "plan {task} --discount 0.9 --verify",
    "plan assistance": "plan {alone} --mode assistance",
    "assistance robust": "plan {alone} --mode assistance --ties robust --format json",
    "check-task": "check-task {task}",
    "explain": "explain {task} --discount 0.9",
    "interruptions": "interruptions {task} --discount 0.9 --format json",
    "recognise": "recognise {task} --goals {goals}",
    "simulate": "simulate {task} {result}",
    "verify": "verify {task} {result}",
    "verify individual": "verify {task} {individual_result}",
    "verify composite": "verify {task} {composite_result}",
    "solve": "solve {task} --discount 0.9",
    "reproduce": "reproduce {suite} --modes serendipity --discounts 0.9",
}
"""By what the table calls them; each runs where its words can be filled in."""

READ_FIRST = ("reproduce",)
"""Commands whose limit holds for reading, and then again."""


@dataclass(frozen=True, slots=True)
class Row:
    """One command on one task.

    Attributes:
        time_limit: seconds.
        memory_limit: MiB, or None.
        code: exit code; None where it was killed.
        over: seconds over the time limit.
        processor_over: the same in processor time.
        peak: most memory, in MiB.
    """

    command: str
    task: str
    time_limit: float
    memory_limit: float | None
    code: int | None
    over: float
    processor_over: float
    peak: float

    @property
    def kept(self) -> bool:
        """Whether the time limit was kept."""
        return self.over <= SHARE * self.time_limit + EXTRA

    @property
    def answered(self) -> bool:
        """Whether there was an answer, or a proof that there is none."""
        return self.code in (0, 3)

    @property
    def memory_over(self) -> float:
        """Share of the memory limit by which the peak is above it."""
        return 0.0 if self.memory_limit is None else self.peak / self.memory_limit - 1


def main() -> None:
    """Measure and print tables."""
    arguments = _arguments()
    commands = {name: COMMANDS[name] for name in arguments.commands.split(",")}
    words = {word for command in commands.values() for _, word, *_ in Formatter().parse(command) if word}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        tasks = [] if arguments.no_own else [*own_tasks(folder)]
        if arguments.suite is not None:
            tasks += tasks_of_suite(arguments.suite, arguments.stride)
        tasks = [task for task in tasks if task.name.startswith(tuple(arguments.tasks.split(",")))]
        tasks = [with_files(task, words, folder / f"files{i}") for i, task in enumerate(tasks)]
        seconds = [float(limit) for limit in arguments.limits.split(",") if limit]
        limits = Limits(seconds, arguments.memory, processor=arguments.processor)
        rows = list(_written(_measured(commands, tasks, limits, folder), arguments.csv))
    _table_of_times(rows)
    _table_of_memory(rows)


def _written(rows: Iterator[Row], file: Path | None) -> Iterator[Row]:
    """The rows, each in the file at once."""
    with Path(file or os.devnull).open("w", buffering=1, newline="", encoding="utf-8") as text:
        writer = csv.writer(text)
        writer.writerow([field.name for field in fields(Row)])
        for row in rows:
            writer.writerow(astuple(row))
            yield row


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--no-own", action="store_true", help="no buildings, nor millions of actions")
    parser.add_argument("--suite", type=Path, default=None, help="folder of domains in MA-PDDL")
    parser.add_argument("--stride", type=int, default=8, help="take every N-th task of each domain")
    parser.add_argument("--tasks", default="", help="only tasks whose names begin so")
    parser.add_argument("--commands", default=",".join(COMMANDS), help="some of the table's commands")
    parser.add_argument("--limits", default=LIMITS, help="seconds, or none")
    parser.add_argument("--memory", type=float, default=None, help="MiB, on the ten largest tasks; 0: none")
    parser.add_argument("--processor", action="store_true", help="limits are on processor time")
    parser.add_argument("--csv", type=Path, default=None, help="write rows here")
    return parser.parse_args()


# -- processes


class Limits(NamedTuple):
    """What is measured.

    Attributes:
        seconds: limits on time.
        memory: MiB for the ten largest tasks; None for little, and all of them; 0 for none.
        processor: whether time is processor time.
    """

    seconds: list[float]
    memory: float | None
    processor: bool


def _measured(commands: dict[str, str], tasks: list[Named], limits: Limits, folder: Path) -> Iterator[Row]:
    largest = sorted(tasks, key=lambda task: task.size)[-LARGEST:]
    run = Runner(PROCESSOR if limits.processor else USUAL, folder)
    for name, words in commands.items():
        start: Ended | None = None
        for task in tasks:
            try:
                command = words.format(**task.words).split()
            except KeyError:  # no answer to check, say
                continue
            start = start or run.started(command, PATIENCE)
            late = False
            for limit in limits.seconds:
                allowed = limit * (2 if name in READ_FIRST else 1)
                ended = run([*command, "--time-limit", f"{limit:g}"], allowed + PATIENCE)
                over = ended.processor - start.processor - allowed
                total = over if limits.processor else ended.seconds - start.seconds - allowed
                yield Row(name, task.name, limit, None, ended.code, total, over, ended.peak)
                late = late or ended.code is None
            if not late and (limits.memory is None or (limits.memory and task in largest)):
                most = limits.memory or round(start.peak + ABOVE)
                words_of_both = ["--time-limit", f"{CONFINED_FOR:g}", "--memory-limit", f"{most:g}"]
                ended = run([*command, *words_of_both], 2 * CONFINED_FOR + PATIENCE)
                yield Row(name, task.name, CONFINED_FOR, most, ended.code, 0.0, 0.0, ended.peak)


# -- tables


def _table_of_times(rows: list[Row]) -> None:
    timed = [row for row in rows if row.memory_limit is None]
    print(f"{'command':20}{'limit':>6}{'runs':>6}{'kept':>6}{'with answer':>13}   most over, ms (processor)")
    for command, limit in dict.fromkeys((row.command, row.time_limit) for row in timed):
        members = [row for row in timed if (row.command, row.time_limit) == (command, limit)]
        worst = max(members, key=lambda row: row.over)
        shown = "killed" if worst.code is None else f"{worst.over * 1000:.0f}"
        counts = f"{len(members):>6}{_count(row.kept for row in members):>6}"
        counts += f"{_count(row.answered for row in members):>13}"
        print(
            f"{command:20}{limit:>4g} s{counts}   {shown} ({worst.processor_over * 1000:.0f}), {worst.task}"
        )
    odd = [row for row in rows if row.code not in (0, 3, 4, None)]
    for row in odd:  # 2: a horizon is missing where the human has no plan alone
        print(f"exit {row.code}: {row.command}, {row.task}, {row.time_limit:g} s")
    late = [row for row in timed if not row.kept]
    print(f"\nnot kept: {len(late)} of {len(timed)}")
    for row in late:
        over = f"{row.over * 1000:.0f} ms ({row.processor_over * 1000:.0f}), exit {row.code}"
        print(f"  {row.command}, {row.task}, {row.time_limit:g} s: {over}, {row.peak:.0f} MiB")


def _table_of_memory(rows: list[Row]) -> None:
    print(f"\n{'command':20}{'runs':>6}{'with answer':>13}   highest peak, of the memory limit")
    confined = [row for row in rows if row.memory_limit is not None]
    for command in dict.fromkeys(row.command for row in confined):
        members = [row for row in confined if row.command == command]
        worst = max(members, key=lambda row: row.memory_over)
        shown = f"{worst.memory_over:+.0%} ({worst.peak:.0f} of {worst.memory_limit:.0f} MiB), {worst.task}"
        answered = _count(row.answered for row in members)
        print(f"{command:20}{len(members):>6}{answered:>13}   {shown}, exit {worst.code}")
        unanswered = ", ".join(row.task for row in members if not row.answered)
        if unanswered:
            print(f"{'':20}without: {unanswered}")


def _count(flags: Iterable[bool]) -> int:
    return sum(flags)


if __name__ == "__main__":
    main()
