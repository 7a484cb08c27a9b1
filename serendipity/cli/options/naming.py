"""How a command line names a task: two files, one pair per agent, a folder, or an example."""

import sys
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import typer

from serendipity.cli.options import limits, settings
from serendipity.cli.streams import output, progress
from serendipity.model.errors import UsageError
from serendipity.model.printable import message
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task

Files = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="TASK",
        help="DOMAIN PROBLEM, or a folder with a folder per agent and superagent/.",
        show_default=False,
    ),
]
FilesAndResult = Annotated[
    list[Path],
    typer.Argument(
        metavar="TASK RESULT.json",
        help="The task, named as for `plan`; then the result.",
        show_default=False,
    ),
]
Human = Annotated[
    str | None, typer.Option("--human", metavar="H", help="The human; by default the only agent with a goal.")
]
Robots = Annotated[
    list[str] | None,
    typer.Option(
        "--robot",
        metavar="R",
        help="A robot (with DOMAIN PROBLEM; repeat it). In MA-PDDL 'all', or none, means all other agents.",
    ),
]
Agents = Annotated[
    list[str] | None,
    typer.Option("--agent", metavar="A=DOMAIN,PROBLEM", help="An agent and its own files (repeat it)."),
]
Team = Annotated[
    str | None,
    typer.Option("--team", metavar="DOMAIN,PROBLEM", help="With --agent: the files of the joint actions."),
]


def _examples() -> list[tuple[str, str]]:
    from serendipity.scenarios.examples import EXAMPLES

    return [(shipped.name, shipped.summary) for shipped in EXAMPLES.values()]


Example = Annotated[
    str | None,
    typer.Option("--example", metavar="NAME", help="A task that is shipped.", autocompletion=_examples),
]


def load(
    files: Iterable[Path] | None,
    human: str | None,
    robots: Iterable[str] | None,
    agents: Iterable[str] | None,
    team: str | None,
    example: str | None,
    *,
    quiet: bool,
    deadline: Deadline | None = None,
) -> Task:
    """The task that the words of a command line name; its warnings go to stderr.

    Raises:
        UsageError: no way of naming a task, two at once, or half of one.
        InputError: a file can't be read or understood.
        LimitReachedError: the deadline ran out.
    """
    name = task_name(files, human, robots, agents, team, example)
    with progress.working("reading", quiet=quiet), limits.during("reading the task"):
        task = name.load(deadline)
    output.warn(task.warnings, quiet=quiet)
    return task


def task_name(
    files: Iterable[Path] | None,
    human: str | None,
    robots: Iterable[str] | None,
    agents: Iterable[str] | None,
    team: str | None,
    example: str | None,
) -> "TaskName":
    """What the words of a command line name, and the settings where it says nothing."""
    given = TaskName(
        tuple(files or ()), human, tuple(robots or ()), tuple(agents or ()), team=team, example=example
    )
    known = settings.in_force()
    if known.file is not None and "logging" in sys.modules:
        import logging

        logging.getLogger("serendipity.settings").info("settings from %s", message(str(known.file)))
    if example is not None:
        return given  # its agents are its own
    named = replace(given, human=human or known.human)
    if not given.files and not given.agents and team is None:
        return replace(named, agents=known.agents, team=known.team)
    return replace(named, robots=known.robots) if len(given.files) == 2 and not given.robots else named


@dataclass(frozen=True, slots=True)
class TaskName:
    """The words that name a task; exactly one of the four ways."""

    files: tuple[Path, ...] = ()
    human: str | None = None
    robots: tuple[str, ...] = ()
    agents: tuple[str, ...] = ()
    team: str | None = None
    example: str | None = None

    def load(self, deadline: Deadline | None = None) -> Task:
        """The task.

        Raises:
            UsageError: no way of naming a task, two at once, or half of one.
            InputError: a file can't be read or understood.
            LimitReachedError: the deadline ran out.
        """
        ways = [bool(self.files), bool(self.agents), self.example is not None]
        if sum(ways) != 1:
            raise UsageError(
                "task: expected one of DOMAIN PROBLEM --human H --robot R, --agent A=DOMAIN,PROBLEM ..., "
                f"a folder, or --example NAME; got {'none' if not any(ways) else 'more than one'}"
            )
        if self.team is not None and not self.agents:
            raise UsageError("--team: goes with --agent only")
        if self.robots and len(self.files) != 2:
            raise UsageError("--robot: goes with DOMAIN PROBLEM only")
        if self.example is not None:
            return self._from_example(self.example, deadline)
        if self.agents:
            return self._from_agents(deadline)
        return self._from_files(deadline)

    def _from_example(self, name: str, deadline: Deadline | None) -> Task:
        from serendipity.scenarios.examples import example

        task = example(name, deadline=deadline)
        return task if self.human is None else task.with_human(self.human)

    def _from_agents(self, deadline: Deadline | None) -> Task:
        from serendipity.pddl import read_agents

        pairs: dict[str, tuple[Path, Path]] = {}
        for text in self.agents:
            name, _, files = text.partition("=")
            if not name or name in pairs:
                raise UsageError(f"--agent: expected NAME=DOMAIN,PROBLEM, each name once, got '{text}'")
            pairs[name] = _pair(files, f"--agent {name}=")
        team = None if self.team is None else _pair(self.team, "--team ")
        return read_agents(pairs, team=team, human=self.human, deadline=deadline)

    def _from_files(self, deadline: Deadline | None) -> Task:
        from serendipity.pddl import read_folder, read_pddl

        if len(self.files) == 1:
            return read_folder(self.files[0], human=self.human, deadline=deadline)
        domain, problem, *more = self.files
        if more:
            raise UsageError(f"task: expected DOMAIN PROBLEM or one folder, got {len(self.files)} paths")
        try:
            return read_pddl(domain, problem, human=self.human or "", robots=self.robots, deadline=deadline)
        except UsageError as error:
            if self.human is not None:
                raise
            raise UsageError(f"{error}; name --human H --robot R ..., in MA-PDDL --human H") from None


def _pair(text: str, where: str) -> tuple[Path, Path]:
    files = text.split(",")
    if len(files) != 2 or not all(files):
        raise UsageError(f"{where}: expected DOMAIN,PROBLEM, got '{text}'")
    return Path(files[0]), Path(files[1])
