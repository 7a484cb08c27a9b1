"""The tasks on which limits are measured, and the words that name them on a command line.

A building of 2,100 rooms and 10 medkits, one of 840 and 2; two files of 46 objects and one action of
four parameters, which has 4.5 million ground actions: of two agents, and of 46; and those of a suite
of domains (``serendipity.evaluation.benchmark.coverage``), with two robots.
"""

import argparse
import json
import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final, TypeVar

import serendipity
from benchmarks.alone import may_alone
from serendipity import Task
from serendipity.evaluation.benchmark.coverage import Problem, Roles, problems
from serendipity.evaluation.benchmark.coverage.suite import roles
from serendipity.model.resources.processes import in_processes

T = TypeVar("T")

_SECONDS: Final = 1.0
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
            read: ``goals``; answers in several modes, by the words of ``ANSWERED``.
        size: number of ground actions, where it was looked at.
    """

    name: str
    words: dict[str, str]
    size: int = 0


ANSWERED: Final[dict[str, dict[str, object]]] = {
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
        who = roles(problem, _ROBOTS, may_alone)
        files = f"{problem.domain_file} {problem.problem_file} --human {who.human}"
        words = {
            "task": files + "".join(f" --robot {robot}" for robot in who.robots),
            "alone": f"{files} --robot {who.robots[0]}",
        }
        found.append(Named(f"{problem.domain} {problem.name}", words, len(_read(problem, who).actions)))
    return found


def _read(problem: Problem, who: Roles) -> Task:
    return serendipity.load_pddl(problem.domain_file, problem.problem_file, who.human, who.robots)


def _apart(work: Callable[..., T], *given: object) -> T:
    """Do something in a process of its own: what a process has at most counts from what its parent has."""
    (found,) = in_processes(partial(_done, work), [given], 1)
    return found


def _done(work: Callable[..., T], given: tuple[object, ...]) -> T:
    return work(*given)


def _large(folder: Path) -> str:
    folder.mkdir(exist_ok=True)
    objects = " ".join(f"o{i}" for i in range(46))
    clean = " ".join(f"(clean o{i})" for i in range(46))
    problem = f"(define (problem p) (:domain large) (:objects {objects}) (:init {clean}) (:goal (done o1)))"
    (folder / "domain.pddl").write_text(_LARGE_DOMAIN)
    (folder / "problem.pddl").write_text(problem)
    return f"{folder / 'domain.pddl'} {folder / 'problem.pddl'}"


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
        # The goals first: answers to them need the file.
        found |= _apart(_write_files, named.words, sorted(missing, key=lambda word: word != "goals"), own)
        index.write_text(json.dumps(found))
    words = {word: file for word, file in found.items() if file is not None}
    return Named(named.name, named.words | words, named.size)


def _write_files(words: dict[str, str], wanted: list[str], folder: Path) -> dict[str, str | None]:
    """Files by the words that name them; None for what there is not."""
    found: dict[str, str | None] = dict.fromkeys(wanted)
    for name in wanted:
        alone = name == "assistance_result"
        if alone and "alone" not in words:
            continue
        with suppress(serendipity.SerendipityError):
            task = _loaded(words["alone" if alone else "task"].split())
            written = _goals(task) if name in ("goals", "goals_result") else None
            if name == "goals":
                (folder / "goals.json").write_text(json.dumps(written))
                found["goals"] = str(folder / "goals.json")
                continue
            answer = serendipity.plan(task, goals=written, time_limit=_SECONDS, **ANSWERED[name])
            if answer.status != "unknown":
                (folder / f"{name}.json").write_text(json.dumps(answer.to_dict()))
                found[name] = str(folder / f"{name}.json")
    return found


def _goals(task: Task) -> list[dict[str, list[str]]]:
    """Up to three goals: the facts of the task's own, one by one."""
    return [{"goal": [task.facts[fact]]} for fact in sorted(task.goal.positive)[:3]]


def _loaded(words: list[str]) -> Task:
    """What a command line names."""
    parser = argparse.ArgumentParser()
    parser.add_argument("files", nargs="*")
    parser.add_argument("--example")
    parser.add_argument("--human")
    parser.add_argument("--robot", action="append", default=[])
    parser.add_argument("--agent", action="append", default=[])
    named = parser.parse_args(words)
    limit = serendipity.Deadline(time_limit=5 * _SECONDS)
    if named.example is not None:
        return serendipity.example(named.example, deadline=limit)
    if named.agent:
        agents = dict(agent.split("=") for agent in named.agent)
        files = {agent: tuple(pair.split(",")) for agent, pair in agents.items()}
        return serendipity.load_agents(files, human=named.human, deadline=limit)  # type: ignore[arg-type]
    if len(named.files) == 1:
        return serendipity.load(named.files[0], named.human, deadline=limit)
    domain, problem = named.files
    return serendipity.load_pddl(domain, problem, named.human, named.robot, deadline=limit)
