"""How well every command keeps ``--time-limit`` and ``--memory-limit``, as a process.

    python -m benchmarks.limits [--codmap FOLDER] [--commands plan,...] [--csv FILE]

Tasks: a building of 2,100 rooms and 10 medkits, one of 840 and 2, ten of the multi-agent competition
of 2015 (``--codmap``: a folder for each of its domains), and two files of 46 objects and one action
of four parameters, which has 4.5 million ground actions: of two agents, and of 46.

A command starts when the interpreter and its modules are loaded; how long that takes is measured
by the same command with a limit of 0, and taken off.  What is left over the limit is the *overrun*; a limit
is *kept* if that is at most 10 % of it and 50 ms.  ``reproduce`` has the limit twice: for reading,
and for its row.  A process that is late by 15 s is killed.  On a busy machine the deadline also counts what
others do: the overrun in processor time, told beside it, is at least what the process did too much.

Then the same with a limit on memory, 40 MiB above what the process has when it starts: how far the peak
is above the limit, in percent.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import astuple, dataclass, fields
from multiprocessing import get_context
from pathlib import Path

import serendipity
from serendipity import Task

LIMITS = (0.05, 0.5, 2.0)
"""Seconds."""

SHARE, EXTRA = 0.1, 0.05
"""What may be added to a limit: of it, and seconds."""

PATIENCE = 15.0
"""Seconds after which a late process is killed."""

ABOVE = 40
"""MiB that a process may add to what it has when it starts."""

CODMAP = {
    "blocksworld 9-0": ("blocksworld", "probBLOCKS-9-0.pddl", "a1 a2 a3"),
    "blocksworld 16-2": ("blocksworld", "probBLOCKS-16-2.pddl", "a1 a2 a3"),
    "driverlog 7": ("driverlog", "pfile7.pddl", "driver1 driver2 driver3"),
    "driverlog 19": ("driverlog", "pfile19.pddl", "driver1 driver2 driver3"),
    "rovers 10": ("rovers", "p10.pddl", "rover0 rover1 rover2"),
    "rovers 28": ("rovers", "p28.pddl", "rover0 rover1 rover2"),
    "satellites 5": ("satellites", "p05-pfile5.pddl", "satellite0 satellite1 satellite2"),
    "satellites 20": ("satellites", "p20-pfile20.pddl", "satellite0 satellite1 satellite2"),
    "zenotravel 7": ("zenotravel", "pfile7.pddl", "plane1 plane2"),
    "zenotravel 22": ("zenotravel", "pfile22.pddl", "plane1 plane2 plane3"),
}
"""Tasks of the competition: domain, problem, and its agents, the human first."""

COMMANDS = {
    "plan": "plan {task} --discount 0.9",
    "plan K=0": "plan {task} --discount 0.9 --window-weight 0",
    "plan communication": "plan {task} --discount 0.9 --mode communication --format json",
    "plan composite": "plan {task} --discount 0.9 --mode composite --horizon inf",
    "plan local": "plan {task} --discount 0.9 --human-model local",
    "plan ties": "plan {task} --discount 0.9 --ties robust --max-ties 1000000",
    "plan goals": "plan {task} --discount 0.9 --goals {goals}",
    "plan verify": "plan {task} --discount 0.9 --verify",
    "plan assistance": "plan {alone} --mode assistance",
    "assistance robust": "plan {alone} --mode assistance --ties robust --format json",
    "check-task": "check-task {task}",
    "explain": "explain {task} --discount 0.9",
    "interruptions": "interruptions {task} --discount 0.9 --format json",
    "recognise": "recognise {task} --goals {goals}",
    "simulate": "simulate {task} {result}",
    "verify": "verify {task} {result}",
    "solve": "solve {task} --discount 0.9",
    "reproduce": "reproduce {suite} --modes serendipity --discounts 0.9",
}
"""By what the table calls them; each runs where its words can be filled in."""

READ_FIRST = ("reproduce",)
"""Commands whose limit holds for reading, and then again."""

LARGE_DOMAIN = """
(define (domain large) (:requirements :strips)
  (:predicates (clean ?x) (mixed ?x ?y) (done ?x))
  (:action mix :parameters (?a ?b ?c ?d)
    :precondition (and (clean ?a) (clean ?b) (clean ?c) (clean ?d))
    :effect (and (mixed ?a ?b) (done ?d))))
"""


@dataclass(frozen=True, slots=True)
class Named:
    """A task, and the words that name it and what belongs to it on a command line."""

    name: str
    words: dict[str, str]


@dataclass(frozen=True, slots=True)
class Ended:
    """How a process ended.

    Attributes:
        code: its exit code; None where it was killed.
        seconds: from its start.
        processor: seconds of processor time.
        peak: most memory, in MiB.
    """

    code: int | None
    seconds: float
    processor: float
    peak: float


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
    def memory_over(self) -> float:
        """Share of the memory limit by which the peak is above it."""
        return 0.0 if self.memory_limit is None else self.peak / self.memory_limit - 1


def main() -> None:
    """Measure and print tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--codmap", type=Path, default=None, help="folder of the competition's domains")
    parser.add_argument("--commands", default=",".join(COMMANDS), help="some of the table's commands")
    parser.add_argument("--tasks", default="", help="only tasks whose names begin so")
    parser.add_argument("--csv", type=Path, default=None, help="write rows here")
    arguments = parser.parse_args()
    commands = {name: COMMANDS[name] for name in arguments.commands.split(",")}
    with tempfile.TemporaryDirectory() as scratch:
        found = _tasks(Path(scratch), arguments.codmap)
        tasks = [task for task in found if task.name.startswith(tuple(arguments.tasks.split(",")))]
        rows = list(_measured(commands, tasks, Path(scratch)))
    _table_of_times(rows)
    _table_of_memory(rows)
    if arguments.csv is not None:
        with arguments.csv.open("w", newline="", encoding="utf-8") as text:
            writer = csv.writer(text)
            writer.writerow([field.name for field in fields(Row)])
            writer.writerows(astuple(row) for row in rows)


# -- tasks


def _tasks(scratch: Path, codmap: Path | None) -> Iterator[Named]:
    for rooms, medkits in ((2100, 10), (840, 2)):
        suite = scratch / f"rooms{rooms}"
        serendipity.generate_usar(suite / "test1", rooms=rooms, medkits=medkits)
        words = {"task": str(suite / "test1"), "alone": str(suite / "test1"), "suite": str(suite)}
        yield _with_files(f"{rooms} rooms", words, suite)
    if codmap is not None:
        for name, (domain, problem, agents) in CODMAP.items():
            files = f"{codmap / domain / 'domain.pddl'} {codmap / domain / problem}"
            words = _of_agents(files, agents.split())
            yield _with_files(name, words, scratch / name.replace(" ", ""))
    files = _large(scratch / "large")
    for count in (2, 46):
        objects = [f"o{i}" for i in range(count)]
        yield Named(f"4.5 million, {count} agents", _of_agents(files, objects))


def _of_agents(files: str, agents: list[str]) -> dict[str, str]:
    human, *robots = agents
    words = f"{files} --human {human}"
    return {
        "task": words + "".join(f" --robot {robot}" for robot in robots),
        "alone": f"{words} --robot {robots[0]}",
    }


def _large(folder: Path) -> str:
    folder.mkdir()
    objects = " ".join(f"o{i}" for i in range(46))
    clean = " ".join(f"(clean o{i})" for i in range(46))
    problem = f"(define (problem p) (:domain large) (:objects {objects}) (:init {clean}) (:goal (done o1)))"
    (folder / "domain.pddl").write_text(LARGE_DOMAIN)
    (folder / "problem.pddl").write_text(problem)
    return f"{folder / 'domain.pddl'} {folder / 'problem.pddl'}"


def _with_files(name: str, words: dict[str, str], folder: Path) -> Named:
    """A task with goals to recognise and an answer to check, where it can be read and answered."""
    folder.mkdir(exist_ok=True)
    # In a process of its own: what a process has at most counts from what its parent has.
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as apart:
        found = apart.submit(_write_files, words["task"].split(), folder).result()
    return Named(name, {**words, **found})


def _write_files(words: list[str], folder: Path) -> dict[str, str]:
    found = {}
    with suppress(serendipity.SerendipityError):
        task = _loaded(words)
        goals, result = folder / "goals.json", folder / "result.json"
        listed = [task.facts[fact] for fact in task.goal.positive][:3]
        goals.write_text(json.dumps([{"goal": [fact]} for fact in listed]))
        found["goals"] = str(goals)
        answer = serendipity.plan(task, discount="0.9", time_limit=5)
        if answer.plan is not None:
            result.write_text(json.dumps(answer.to_dict()))
            found["result"] = str(result)
    return found


def _loaded(words: list[str]) -> Task:
    if len(words) == 1:
        return serendipity.load(words[0])
    domain, problem, _, human, *robots = words
    return serendipity.load_pddl(domain, problem, human, robots[1::2])


# -- processes


def _measured(commands: dict[str, str], tasks: list[Named], folder: Path) -> Iterator[Row]:
    for name, words in commands.items():
        start: Ended | None = None
        for task in tasks:
            try:
                command = words.format(**task.words).split()
            except KeyError:  # no answer to check, say
                continue
            start = start or _started(command, folder)
            late = False
            for limit in LIMITS:
                allowed = limit * (2 if name in READ_FIRST else 1)
                yield (row := _timed(name, task, command, limit, allowed, start, folder))
                late = late or row.code is None
            if not late:
                yield _confined(name, task, command, start, folder)


def _started(command: list[str], folder: Path) -> Ended:
    """A command that starts, loads its modules, and ends at once: the quickest of some."""
    runs = [_run([*command, "--time-limit", "0"], folder, PATIENCE) for _ in range(5)]
    return min(runs, key=lambda ended: ended.seconds)


def _timed(
    name: str, task: Named, command: list[str], limit: float, allowed: float, start: Ended, folder: Path
) -> Row:
    ended = _run([*command, "--time-limit", f"{limit:g}"], folder, allowed + PATIENCE)
    over = ended.seconds - start.seconds - allowed
    processor = ended.processor - start.processor - allowed
    return Row(name, task.name, limit, None, ended.code, over, processor, ended.peak)


def _confined(name: str, task: Named, command: list[str], start: Ended, folder: Path) -> Row:
    """With little memory, and 20 s."""
    most = round(start.peak + ABOVE)
    words = [*command, "--time-limit", "20", "--memory-limit", str(most)]
    ended = _run(words, folder, 40 + PATIENCE)
    return Row(name, task.name, 20.0, most, ended.code, 0.0, 0.0, ended.peak)


def _run(words: list[str], folder: Path, patience: float) -> Ended:
    started = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "serendipity", *words, "--quiet"],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    while True:
        pid, status, used = os.wait4(process.pid, os.WNOHANG)
        seconds = time.perf_counter() - started
        if pid:
            break
        if seconds > patience:
            process.kill()
            _, status, used = os.wait4(process.pid, 0)
            break
        time.sleep(0.001)
    process.returncode = os.waitstatus_to_exitcode(status)
    code = None if process.returncode < 0 else process.returncode
    return Ended(code, seconds, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


# -- tables


def _table_of_times(rows: list[Row]) -> None:
    print(f"{'command':20}{'runs':>6}{'kept':>6}   greatest overrun, ms (processor time), by limit")
    for command in dict.fromkeys(row.command for row in rows):
        timed = [row for row in rows if row.command == command and row.memory_limit is None]
        cells = []
        for limit in LIMITS:
            worst = max((row for row in timed if row.time_limit == limit), key=lambda row: row.over)
            shown = "killed" if worst.code is None else f"{worst.over * 1000:.0f}"
            cells.append(f"{limit:g} s: {shown} ({worst.processor_over * 1000:.0f}), {worst.task}")
        print(f"{command:20}{len(timed):>6}{sum(row.kept for row in timed):>6}   {'; '.join(cells)}")
    print("\nnot kept:")
    for row in rows:
        if row.memory_limit is None and not row.kept:
            over = f"{row.over * 1000:.0f} ms ({row.processor_over * 1000:.0f}), exit {row.code}"
            print(f"  {row.command}, {row.task}, {row.time_limit:g} s: {over}, {row.peak:.0f} MiB")


def _table_of_memory(rows: list[Row]) -> None:
    print(f"\n{'command':20}{'runs':>6}   highest peak, of the memory limit")
    confined = [row for row in rows if row.memory_limit is not None]
    for command in dict.fromkeys(row.command for row in confined):
        members = [row for row in confined if row.command == command]
        worst = max(members, key=lambda row: row.memory_over)
        shown = f"{worst.memory_over:+.0%} ({worst.peak:.0f} of {worst.memory_limit:.0f} MiB), {worst.task}"
        print(f"{command:20}{len(members):>6}   {shown}, exit {worst.code}")


if __name__ == "__main__":
    main()
