"""The tasks on which limits are measured, and the commands on them.

*Own* tasks: a building of 2,100 rooms and 10 medkits, one of 840 and 2; two files of 46 objects and one
action of four parameters, which has 4.5 million ground actions: of two agents, and of 46.  Tasks of a
*suite* have two robots.  Tasks of *all kinds*: some of the published buildings, of the suite, of the
published problems of silent assistance, buildings that are generated, and what is shipped.
"""

import json
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from string import Formatter
from typing import Final

import serendipity
from benchmarks.problems import silent
from serendipity import SerendipityError, Task
from serendipity.evaluation.measuring.running import apart
from serendipity.evaluation.measuring.suites import folders, may_alone, problems, roles
from serendipity.scenarios.examples import EXAMPLES

MODES: Final = {
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
"""Commands by what the table calls them; each runs where its words can be filled in."""

CERTIFICATES: Final = {
    f"verify{mode.removeprefix('plan')}": f"verify {'{alone}' if '{alone}' in line else '{task}'} {{{mode}}}"
    for mode, line in MODES.items()
}
"""Of the answer to each of these, which stands in a file."""

OTHERS: Final = {
    "individual verify": "plan {task} --mode individual --verify",
    "composite verify": "plan {task} --discount 0.9 --mode composite --horizon inf --verify",
    "plan verify": "plan {task} --discount 0.9 --verify",
    "assistance robust": "plan {alone} --mode assistance --ties robust --format json",
    "check-task": "check-task {task}",
    "explain": "explain {task} --discount 0.9",
    "interruptions": "interruptions {task} --discount 0.9 --format json",
    "recognise": "recognise {task} --goals {goals}",
    "simulate": "simulate {task} {plan}",
    "solve": "solve {task} --discount 0.9",
}


ANSWERING: Final = 1.0
"""Seconds for an answer to check."""

FOUND: Final = (0, 3)
"""Exit codes of an answer, or a proof that there is none."""

_SIGNS: Final = r"\W+"
"""All that is no part of a file's name."""

_LARGE_DOMAIN: Final = """
(define (domain large) (:requirements :strips)
  (:predicates (clean ?x) (mixed ?x ?y) (done ?x))
  (:action mix :parameters (?a ?b ?c ?d)
    :precondition (and (clean ?a) (clean ?b) (clean ?c) (clean ?d))
    :effect (and (mixed ?a ?b) (done ?d))))
"""

_BUILDINGS: Final = (
    *((21, 2, 1), (42, 2, 1), (42, 4, 2), (84, 2, 1), (84, 4, 3)),
    *((210, 2, 1), (210, 10, 1), (420, 2, 3), (840, 2, 1), (2100, 10, 1)),
)
"""Rooms, medkits, robots."""


@dataclass(frozen=True, slots=True)
class Named:
    """A task, and what names it and what belongs to it on a command line.

    Attributes:
        name: of the task.
        words: ``task``; with one robot only, ``alone``; files to
            read: ``goals``; answers, by what answered in ``MODES``.
        load: gives the task.
        size: number of ground actions, where it was looked at.
    """

    name: str
    words: dict[str, str]
    load: Callable[[], Task]
    size: int = 0


def tasks(study: str, suite: Path, stride: int, folder: Path) -> Iterator[Named]:
    """The tasks of a study, which may be written to a folder."""
    if study == "commands":
        yield from _own_tasks(folder)
    elif study == "verify":
        for place in folders(suite.parent / "usar200", 10):
            yield _in_folder(f"usar {place.name}", place, robots=1)
        for rooms, medkits, robots in _BUILDINGS:
            place = folder / f"building{rooms}-{medkits}-{robots}"
            serendipity.generate_usar(place, rooms=rooms, medkits=medkits, robots=robots)
            yield _in_folder(f"{rooms} rooms, {medkits} medkits, {robots} robots", place, robots)
        for name, *files in islice(silent(suite.parent / "spa"), 0, 72, 6):
            pairs = dict(zip(("prime", "supporter"), files, strict=True))
            agents = "".join(f"--agent {who}={domain},{file} " for who, (domain, file) in pairs.items())
            words = dict.fromkeys(("task", "alone"), f"{agents}--human prime")
            yield Named(f"spa {name}", words, partial(serendipity.load_agents, pairs, human="prime"))
        for name, shipped in EXAMPLES.items():
            words = dict.fromkeys(("task", "alone")[: 3 - len(shipped.robots)], f"--example {name}")
            yield Named(name, words, partial(serendipity.example, name))
    yield from apart(_of_suite, suite, stride)


def _own_tasks(scratch: Path) -> Iterator[Named]:
    """Buildings, and what has millions of ground actions."""
    for rooms, medkits in ((2100, 10), (840, 2)):
        place = scratch / f"rooms{rooms}"
        serendipity.generate_usar(place, rooms=rooms, medkits=medkits)
        yield _in_folder(f"{rooms} rooms", place, robots=1)
    objects, clean = (" ".join(word.format(i) for i in range(46)) for word in ("o{}", "(clean o{})"))
    domain, problem = scratch / "large-domain.pddl", scratch / "large-problem.pddl"
    domain.write_text(_LARGE_DOMAIN)
    problem.write_text(
        f"(define (problem p) (:domain large) (:objects {objects}) (:init {clean}) (:goal (done o1)))"
    )
    for agents in (2, 46):
        robots = tuple(f"o{i}" for i in range(1, agents))
        yield _of_files(f"4.5 million, {agents} agents", domain, problem, "o0", robots)


def _of_suite(folder: Path, stride: int) -> list[Named]:
    """Every N-th task of each domain."""
    found = []
    for problem in problems(folder, stride=stride):
        who, name = roles(problem, 2, may_alone), f"{problem.domain} {problem.name}"
        size = len(problem.task(who).actions)
        found.append(_of_files(name, problem.domain_file, problem.problem_file, who.human, who.robots, size))
    return found


def _in_folder(name: str, folder: Path, robots: int) -> Named:
    words = dict.fromkeys(("task", "alone") if robots == 1 else ("task",), str(folder))
    return Named(name, words, partial(serendipity.load, folder))


def _of_files(
    name: str, domain: Path, problem: Path, human: str, robots: tuple[str, ...], size: int = 0
) -> Named:
    words = f"{domain} {problem} --human {human}"
    options = [f" --robot {robot}" for robot in robots]
    load = partial(serendipity.load_pddl, domain, problem, human, robots, time_limit=5 * ANSWERING)
    return Named(name, {"task": words + "".join(options), "alone": words + options[0]}, load, size)


def lines(
    task: Named, turn: int, commands: dict[str, str], most: int | None, folder: Path
) -> Iterator[tuple[str, str]]:
    """Every command on a task where its words are known, or so many of them, in turn."""
    number = len(commands) if most is None else min(most, len(commands))
    first = turn * number % len(commands)
    names = [*commands][first:] + [*commands][:first]
    own = folder / re.sub(_SIGNS, "-", task.name)
    own.mkdir(exist_ok=True)
    filled = ((name, _filled(task, commands[name], own)) for name in names)
    yield from islice(((name, line) for name, line in filled if line is not None), number)


def _filled(task: Named, line: str, folder: Path) -> str | None:
    """A command line whose words are filled in; None where one is not known.

    Files that it names and that are not there yet are written.
    """
    for word in {word for _, word, *_ in Formatter().parse(line) if word} - {*task.words}:
        file = folder / (re.sub(_SIGNS, "-", word) + ".json")
        if not file.exists():
            if word == "goals":
                apart(_write_goals, task.load, file)
            elif word in MODES and (asked := _filled(task, MODES[word], folder)) is not None:
                limited = [*asked.split(), "--time-limit", f"{ANSWERING:g}", "--quiet", "-o", str(file)]
                command = [sys.executable, "-m", "serendipity", *limited]
                if subprocess.run(command, capture_output=True, check=False).returncode not in FOUND:
                    file.unlink(missing_ok=True)
        if not file.exists() or not file.stat().st_size:
            file.touch()  # there is none, and it need not be looked for again
            return None
        task.words[word] = str(file)
    return line.format(**task.words)


def _write_goals(load: Callable[[], Task], file: Path) -> None:
    """Write three facts of the human's goal, as goals to recognise; nothing where a task is too large."""
    try:
        task = load()
    except SerendipityError:
        return
    file.write_text(json.dumps([{"goal": [task.facts[fact]]} for fact in sorted(task.goal.positive)[:3]]))
