"""The tasks on which limits are measured, and the words that name them on a command line.

*Own* tasks: a building of 2,100 rooms and 10 medkits, one of 840 and 2; two files of 46 objects and one
action of four parameters, which has 4.5 million ground actions: of two agents, and of 46.  Tasks of a
*suite* have two robots.  Tasks of *all kinds* are a hundred: 20 of the published buildings, 10 that are
generated, 32 of the multi-agent competition, 12 of the published problems of silent assistance, 20 random
ones, and the 6 that are shipped.
"""

import json
import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import count, islice
from pathlib import Path
from typing import Any, Final

import serendipity
from benchmarks.problems import silent
from serendipity import Deadline, Task
from serendipity.cli.options.naming import TaskName
from serendipity.evaluation.crosscheck import random_call
from serendipity.evaluation.measuring.running import apart
from serendipity.evaluation.measuring.suites import may_alone, problems, roles
from serendipity.pddl.write import write_pddl
from serendipity.scenarios.examples import EXAMPLES

_SECONDS: Final = 1.0
"""For an answer to check."""

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

ANSWERED: Final[dict[str, dict[str, Any]]] = {
    "result": {"discount": "0.9"},
    "individual_result": {"mode": "individual"},
    "free_window_result": {"discount": "0.9", "window_weight": "0"},
    "communication_result": {"discount": "0.9", "mode": "communication"},
    "composite_result": {"discount": "0.9", "mode": "composite", "horizon": "inf"},
    "local_result": {"discount": "0.9", "human_model": "local"},
    "ties_result": {"discount": "0.9", "ties": "robust", "max_ties": 1_000_000},
    "goals_result": {"discount": "0.9"},
    "assistance_result": {"mode": "assistance"},
}
"""Options of the answers that are there to be checked, by the words that name them."""


@dataclass(frozen=True, slots=True)
class Named:
    """A task, and what names it and what belongs to it on a command line.

    Attributes:
        name: of the task.
        words: ``task``; with one robot only, ``alone``; ``suite``, a folder of tasks; files to
            read: ``goals``; answers in several modes, by the words of ``ANSWERED``.
        size: number of ground actions, where it was looked at.
    """

    name: str
    words: dict[str, str]
    size: int = 0


def own_tasks(scratch: Path) -> Iterator[Named]:
    """Buildings, and what has millions of ground actions."""
    for rooms, medkits in ((2100, 10), (840, 2)):
        suite = scratch / f"rooms{rooms}"
        serendipity.generate_usar(suite / "test1", rooms=rooms, medkits=medkits)
        yield Named(
            f"{rooms} rooms", {**dict.fromkeys(("task", "alone"), str(suite / "test1")), "suite": str(suite)}
        )
    folder = scratch / "large"
    folder.mkdir(exist_ok=True)
    objects, clean = (" ".join(word.format(i) for i in range(46)) for word in ("o{}", "(clean o{})"))
    problem = f"(define (problem p) (:domain large) (:objects {objects}) (:init {clean}) (:goal (done o1)))"
    files = [folder / "domain.pddl", folder / "problem.pddl"]
    for file, text in zip(files, (_LARGE_DOMAIN, problem), strict=True):
        file.write_text(text)
    for agents in (2, 46):
        yield _of_files(f"4.5 million, {agents} agents", files, "o0", [f"o{i}" for i in range(1, agents)])


def tasks_of_suite(folder: Path, stride: int) -> Iterator[Named]:
    """Every N-th task of each domain."""
    yield from apart(_tasks_of_suite, folder, stride)


def _tasks_of_suite(folder: Path, stride: int) -> list[Named]:
    found = []
    for problem in problems(folder, stride=stride):
        who = roles(problem, 2, may_alone)
        name, files = f"{problem.domain} {problem.name}", [problem.domain_file, problem.problem_file]
        found.append(_of_files(name, files, who.human, [*who.robots], len(problem.task(who).actions)))
    return found


def tasks_of_all_kinds(problems_of_others: Path, scratch: Path) -> Iterator[Named]:
    """The hundred tasks, as far as the problems of others are there.

    Args:
        problems_of_others: the folder with ``usar200``, ``codmap15`` and ``spa``.
        scratch: where files go.
    """
    for number in range(1, 201, 10):
        yield _in_folder(f"usar {number}", problems_of_others / f"usar200/test{number}", robots=1)
    for rooms, medkits, robots in _BUILDINGS:
        folder = scratch / f"building{rooms}-{medkits}-{robots}"
        serendipity.generate_usar(folder, rooms=rooms, medkits=medkits, robots=robots)
        yield _in_folder(f"{rooms} rooms, {medkits} medkits, {robots} robots", folder, robots)
    yield from tasks_of_suite(problems_of_others / "codmap15", 3)
    for name, own, other in islice(silent(problems_of_others / "spa"), 0, 72, 6):
        pairs = [f"{who}={domain},{file}" for who, (domain, file) in (("prime", own), ("supporter", other))]
        words = f"--agent {pairs[0]} --agent {pairs[1]} --human prime"
        yield Named(f"spa {name}", {"task": words, "alone": words})
    yield from islice(_drawn(scratch), 20)
    for name, shipped in EXAMPLES.items():
        words = f"--example {name}"
        yield Named(name, {"task": words} | ({"alone": words} if len(shipped.robots) == 1 else {}))


def _drawn(scratch: Path) -> Iterator[Named]:
    for seed in count():
        task = random_call(seed).task
        folder = scratch / f"drawn{seed}"
        write_pddl(task, folder)
        yield _in_folder(f"drawn {seed}", folder, len(task.robots), task.agents[task.human])


def _in_folder(name: str, folder: Path, robots: int, human: str | None = None) -> Named:
    words = str(folder) if human is None else f"{folder} --human {human}"
    return Named(name, {"task": words} | ({"alone": words} if robots == 1 else {}))


def _of_files(name: str, files: list[Path], human: str, robots: list[str], size: int = 0) -> Named:
    words = f"{files[0]} {files[1]} --human {human}"
    robots = [f" --robot {robot}" for robot in robots]
    return Named(name, {"task": words + "".join(robots), "alone": words + robots[0]}, size)


def with_files(named: Named, wanted: set[str], folder: Path) -> Named:
    """A task with goals to recognise and answers to check, where it can be read and answered.

    What is there already from an earlier run is not made again.

    Args:
        named: the task.
        wanted: words to add, as far as they can be.
        folder: where the files go.
    """
    own = folder / re.sub(r"\W+", "-", named.name)
    own.mkdir(exist_ok=True)
    index = own / "words.json"
    found = json.loads(index.read_text()) if index.exists() else {}
    missing = wanted.intersection(("goals", *ANSWERED)) - {*found}
    if missing:
        found |= apart(_write_files, named.words, sorted(missing, key=lambda word: word != "goals"), own)
        index.write_text(json.dumps(found))
    words = {word: file for word, file in found.items() if file is not None}
    return Named(named.name, named.words | words, named.size)


def _write_files(words: dict[str, str], wanted: list[str], folder: Path) -> dict[str, str | None]:
    """Files by the words that name them, the goals first; None for what there is not."""
    found: dict[str, str | None] = dict.fromkeys(wanted)
    for name in wanted:
        with suppress(serendipity.SerendipityError, KeyError):
            task = _loaded(words["alone" if name == "assistance_result" else "task"])
            goals = [{"goal": [task.facts[fact]]} for fact in sorted(task.goal.positive)[:3]]
            content: Any = goals
            if name != "goals":
                asked = {"goals": goals} if name == "goals_result" else {}
                answer = serendipity.plan(task, time_limit=_SECONDS, **asked, **ANSWERED[name])
                content = None if answer.status == "unknown" else answer.to_dict()
            if content is not None:
                file = folder / f"{name}.json"
                file.write_text(json.dumps(content))
                found[name] = str(file)
    return found


def _loaded(words: str) -> Task:
    """What a command line names."""
    given: dict[str, list[str]] = {"files": []}
    left = iter(words.split())
    for word in left:
        key = word[2:] if word.startswith("--") else "files"
        given.setdefault(key, []).append(word if key == "files" else next(left))
    single = {key: given.pop(key)[0] for key in ("human", "example") if key in given}
    files = [*map(Path, given.pop("files"))]
    return TaskName(files=files, **single, **given).read(Deadline(time_limit=5 * _SECONDS))
