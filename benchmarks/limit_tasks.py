"""The tasks on which limits are measured, and the words that name them on a command line.

A building of 2,100 rooms and 10 medkits, one of 840 and 2; two files of 46 objects and one action of
four parameters, which has 4.5 million ground actions: of two agents, and of 46; and those of a suite
of domains (``serendipity.evaluation.benchmark.coverage``), with two robots.
"""

import json
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Final, ParamSpec, TypeVar

import serendipity
from serendipity import Task
from serendipity.evaluation.benchmark.coverage import Problem, Roles, problems
from serendipity.evaluation.benchmark.coverage.suite import roles

P = ParamSpec("P")
T = TypeVar("T")

_SECONDS: Final = 5.0
"""For an answer to check."""

_ROBOTS: Final = 2
"""Of a task of a suite, at most."""

_LARGE_DOMAIN: Final = """
(define (domain large) (:requirements :strips)
  (:predicates (clean ?x) (mixed ?x ?y) (done ?x))
  (:action mix :parameters (?a ?b ?c ?d)
    :precondition (and (clean ?a) (clean ?b) (clean ?c) (clean ?d))
    :effect (and (mixed ?a ?b) (done ?d))))
"""


@dataclass(frozen=True, slots=True)
class Named:
    """A task, and the words that name it and what belongs to it on a command line.

    Attributes:
        name: of the task.
        words: ``task``; with one robot only, ``alone``; ``suite``, a folder of tasks; files to
            read: ``goals``; answers in several modes, such as ``result``.
        size: number of ground actions, where it was looked at.
    """

    name: str
    words: dict[str, str]
    size: int = 0


ANSWERED: Final = {
    "result": {"mode": "serendipity"},
    "individual_result": {"mode": "individual"},
    "composite_result": {"mode": "composite", "horizon": "inf"},
}
"""Options of the answers that are there to be checked, by the words that name them."""


def own_tasks(scratch: Path) -> Iterator[Named]:
    """Buildings, and what has millions of ground actions."""
    for rooms, medkits in ((2100, 10), (840, 2)):
        suite = scratch / f"rooms{rooms}"
        serendipity.generate_usar(suite / "test1", rooms=rooms, medkits=medkits)
        words = {"task": str(suite / "test1"), "alone": str(suite / "test1"), "suite": str(suite)}
        yield Named(f"{rooms} rooms", words)
    files = _large(scratch / "large")
    for count in (2, 46):
        robots = "".join(f" --robot o{i}" for i in range(1, count))
        words = {"task": f"{files} --human o0{robots}", "alone": f"{files} --human o0 --robot o1"}
        yield Named(f"4.5 million, {count} agents", words)


def tasks_of_suite(folder: Path, stride: int) -> Iterator[Named]:
    """Every N-th task of each domain."""
    yield from _apart(_tasks_of_suite, folder, stride)


def _tasks_of_suite(folder: Path, stride: int) -> list[Named]:
    found = []
    for problem in problems(folder, stride=stride):
        who = roles(problem, _ROBOTS, _may_alone)
        files = f"{problem.domain_file} {problem.problem_file} --human {who.human}"
        words = {
            "task": files + "".join(f" --robot {robot}" for robot in who.robots),
            "alone": f"{files} --robot {who.robots[0]}",
        }
        found.append(Named(f"{problem.domain} {problem.name}", words, len(_read(problem, who).actions)))
    return found


def _may_alone(problem: Problem, who: Roles) -> bool:
    """Whether the human alone may reach the goal, if nothing is ever deleted."""
    task = _read(problem, who)
    known = set(task.init)
    waiting = [task.actions[i] for i in task.human_actions]
    while ready := [action for action in waiting if known.issuperset(action.pre)]:
        waiting = [action for action in waiting if not known.issuperset(action.pre)]
        known.update(*(action.add for action in ready))
    return known.issuperset(task.goal.positive)


def _read(problem: Problem, who: Roles) -> Task:
    return serendipity.load_pddl(problem.domain_file, problem.problem_file, who.human, who.robots)


def _apart(work: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Do something in a process of its own: what a process has at most counts from what its parent has."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as apart:
        return apart.submit(work, *arguments, **named).result()


def _large(folder: Path) -> str:
    folder.mkdir()
    objects = " ".join(f"o{i}" for i in range(46))
    clean = " ".join(f"(clean o{i})" for i in range(46))
    problem = f"(define (problem p) (:domain large) (:objects {objects}) (:init {clean}) (:goal (done o1)))"
    (folder / "domain.pddl").write_text(_LARGE_DOMAIN)
    (folder / "problem.pddl").write_text(problem)
    return f"{folder / 'domain.pddl'} {folder / 'problem.pddl'}"


def with_files(named: Named, wanted: set[str], folder: Path) -> Named:
    """A task with goals to recognise and answers to check, where it can be read and answered.

    Args:
        named: the task.
        wanted: words to add, as far as they can be.
        folder: where the files go.
    """
    folder.mkdir(exist_ok=True)
    found = _apart(_write_files, named.words["task"].split(), wanted, folder)
    return Named(named.name, {**named.words, **found}, named.size)


def _write_files(words: list[str], wanted: set[str], folder: Path) -> dict[str, str]:
    found = {}
    with suppress(serendipity.SerendipityError):
        task = _loaded(words)
        if "goals" in wanted:
            goals = folder / "goals.json"
            listed = [task.facts[fact] for fact in task.goal.positive][:3]
            goals.write_text(json.dumps([{"goal": [fact]} for fact in listed]))
            found["goals"] = str(goals)
        for name, options in ANSWERED.items():
            if name not in wanted:
                continue
            answer = serendipity.plan(task, discount="0.9", time_limit=_SECONDS, **options)
            if answer.plan is not None:
                result = folder / f"{name}.json"
                result.write_text(json.dumps(answer.to_dict()))
                found[name] = str(result)
    return found


def _loaded(words: list[str]) -> Task:
    if len(words) == 1:
        return serendipity.load(words[0], deadline=serendipity.Deadline(time_limit=_SECONDS))
    domain, problem, _, human, *robots = words
    limit = serendipity.Deadline(time_limit=_SECONDS)
    return serendipity.load_pddl(domain, problem, human, robots[1::2], deadline=limit)
