"""Suites of tasks: a folder a task; or, in MA-PDDL as competitions give them, a folder a domain.

A domain's folder has ``domain.pddl`` and problem files.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, TypeVar

from serendipity.facade.loading import load_pddl
from serendipity.model.errors import InputError, UsageError
from serendipity.model.task.task import Task
from serendipity.pddl.parsing.files import read_unit
from serendipity.pddl.parsing.lifted import Unit
from serendipity.pddl.work import Work
from serendipity.pictures.map.names import natural

T = TypeVar("T")

_DOMAIN: Final = "domain.pddl"


@dataclass(frozen=True, slots=True)
class SuiteProblem:
    """One problem of a suite: the name of its domain, its own, and its files."""

    domain: str
    name: str
    domain_file: Path
    problem_file: Path

    def unit(self) -> Unit:
        """The problem as it is written."""
        return read_unit(None, self.domain_file, self.problem_file, Work())

    def task(self, who: "Roles") -> Task:
        """The problem as a task; errors as of :func:`serendipity.load_pddl`."""
        return load_pddl(self.domain_file, self.problem_file, who.human, who.robots)


@dataclass(frozen=True, slots=True)
class Roles:
    """Roles of a problem's agents; ``alone`` if the human is known to have a plan alone."""

    human: str
    robots: tuple[str, ...]
    alone: bool = False


def folders(suite: Path, stride: int = 1) -> list[Path]:
    """Every ``stride``-th of the folders in a suite, ``test2`` before ``test10``."""
    found = (path for path in suite.iterdir() if path.is_dir())
    return sorted(found, key=lambda path: natural(path.name))[::stride]


def is_suite(folder: Path) -> bool:
    """True if a folder holds domains with their problems."""
    return any(_problem_files(path) for path in _domains(folder))


def problems(folder: Path, domains: Sequence[str] = (), stride: int = 1) -> list[SuiteProblem]:
    """Every ``stride``-th problem of some domains, or of all; a UsageError where there is no such domain."""
    there = {path.name: path for path in _domains(folder)}
    asked = chosen(domains, there, "--domains") or there
    return [
        SuiteProblem(name, file.stem, path / _DOMAIN, file)
        for name, path in there.items()
        if name in asked
        for file in _problem_files(path)[::stride]
    ]


def chosen(names: Iterable[str], known: Mapping[str, T], what: str, where: str = "") -> dict[str, T]:
    """Values by their names, in this order; else a UsageError says ``what`` they name, and ``where``."""
    found = {}
    for name in names:
        if name not in known:
            raise UsageError(f"{what}: expected some of {', '.join(known)}{where}, got '{name}'")
        found[name] = known[name]
    return found


def _domains(folder: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.iterdir()) if (path / _DOMAIN).is_file())


def _problem_files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.glob("*.pddl") if path.name != _DOMAIN)


def roles(problem: SuiteProblem, robots: int, can_alone: Callable[[SuiteProblem, Roles], bool]) -> Roles:
    """The first agent who can do it alone, else the first; and others. An InputError for fewer than two."""
    unit = problem.unit()
    kinds = {schema.parameters[0].type for schema in unit.domain.schemas if schema.agent}
    fits = unit.domain.types.is_subtype
    agents = [name for name, own in unit.problem.objects.items() if any(fits(own, kind) for kind in kinds)]
    if len(agents) < 2:
        raise InputError("expected two objects or more that can be an ':agent'", problem.problem_file)
    choices = [Roles(human, tuple(a for a in agents if a != human)[:robots]) for human in agents]
    able = next((choice for choice in choices if can_alone(problem, choice)), None)
    return choices[0] if able is None else replace(able, alone=True)


def may_alone(problem: SuiteProblem, who: Roles) -> bool:
    """True if the human alone reaches the goal of the delete relaxation."""
    task = problem.task(who)
    known = set(task.init)
    waiting = [task.actions[i] for i in task.human_actions]
    while ready := [action for action in waiting if known.issuperset(action.pre)]:
        waiting = [action for action in waiting if not known.issuperset(action.pre)]
        known.update(*(action.add for action in ready))
    return known.issuperset(task.goal.positive)
