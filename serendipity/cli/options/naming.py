"""How a command line names a task: two files, one pair per agent, a folder, or an example."""

import sys
from inspect import Parameter
from pathlib import Path
from typing import Annotated, Final

import typer

from serendipity.cli.choices import option
from serendipity.cli.files.reading import read_json
from serendipity.cli.groups import Group
from serendipity.cli.options import limits, settings
from serendipity.cli.streams import output, progress
from serendipity.model import Deadline, Result, Task, UsageError
from serendipity.model.printable import message


def _examples() -> list[tuple[str, str]]:
    from serendipity.scenarios.examples import EXAMPLES

    return [(shipped.name, shipped.summary) for shipped in EXAMPLES.values()]


Files = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="TASK",
        help="DOMAIN PROBLEM, or a folder with a folder per agent and superagent/.",
        show_default=False,
    ),
]


def files(metavar: str, help: str, *, required: bool = True) -> Parameter:  # noqa: A002 - typer's word
    """The files of a command that reads others behind those of the task."""
    argument = typer.Argument(metavar=metavar, help=help, show_default=False)
    kind, default = (list[Path], Parameter.empty) if required else (list[Path] | None, None)
    return Parameter("files", Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, argument])


AND_RESULT: Final = files("TASK RESULT.json", "The task, named as for `plan`; then the result.")
"""Those of a command about a task and a result."""


class TaskName(Group):
    """The words that name a task; exactly one of the four ways."""

    files: Files = None
    human: Annotated[str | None, option("--human H", "The human; by default the only agent with a goal.")] = (
        None
    )
    robot: Annotated[
        list[str] | None,
        option(
            "--robot R",
            "A robot (with DOMAIN PROBLEM; repeat it). In MA-PDDL 'all', or none, means all other agents.",
        ),
    ] = None
    agent: Annotated[
        list[str] | None, option("--agent A=DOMAIN,PROBLEM", "An agent and its own files (repeat it).")
    ] = None
    team: Annotated[
        str | None, option("--team DOMAIN,PROBLEM", "With --agent: the files of the joint actions.")
    ] = None
    example: Annotated[
        str | None, option("--example NAME", "A task that is shipped.", autocompletion=_examples)
    ] = None

    def load(self, deadline: Deadline | None = None) -> Task:
        """The task, with its warnings on stderr.

        Raises:
            UsageError: no way of naming a task, two at once, or half of one.
            InputError: a file can't be read or understood.
            LimitReachedError: the deadline ran out.
        """
        task = self.settled().read(deadline)
        output.warn(*task.warnings)
        return task

    def with_result(self, command: str) -> "tuple[TaskName, Path, Result]":
        """The name without its last file, which is that of a result; that file; the result.

        Args:
            command: named in errors.

        Raises:
            UsageError: the last file can't be a result.
            InputError: it can't be read, or is no result.
        """
        *named, answer = self.files or []
        if answer.suffix == ".pddl" or answer.is_dir():
            raise UsageError(f"{command}: expected TASK and then RESULT.json, got {answer} last")
        return self.but(files=named), answer, Result.from_dict(read_json(answer), answer)

    def settled(self) -> "TaskName":
        """The words, and those of the settings where the command line says nothing."""
        known = settings.in_force()
        if known.file is not None and "logging" in sys.modules:
            import logging

            logging.getLogger("serendipity.settings").info("settings from %s", message(str(known.file)))
        if self.example is not None:
            return self  # its agents are its own
        named = self.but(human=self.human or known.human)
        if not self.files and not self.agent and self.team is None:
            return named.but(agent=[*known.agents], team=known.team)
        return named.but(robot=[*known.robots]) if _are_pair(self.files) and not self.robot else named

    def read(self, deadline: Deadline | None = None) -> Task:
        """The task that these very words name; errors as for :meth:`load`."""
        with progress.working("reading"), limits.during("reading the task"):
            return self._read(deadline)

    def _read(self, deadline: Deadline | None) -> Task:
        named = [f"'{file}'" for file in (self.files or ())[:1]]
        ways = named + ["--agent"] * bool(self.agent) + ["--example"] * (self.example is not None)
        if len(ways) != 1:
            got = f"more than one: {' and '.join(ways)}" if ways else "none"
            raise UsageError(
                "task: expected one of DOMAIN PROBLEM --human H --robot R, --agent A=DOMAIN,PROBLEM ..., "
                f"a folder, or --example NAME; got {got}"
            )
        if self.team is not None and not self.agent:
            raise UsageError("--team: goes with --agent only")
        if self.robot and not _are_pair(self.files):
            raise UsageError("--robot: goes with DOMAIN PROBLEM only")
        if self.example is not None:
            from serendipity.scenarios.examples import example

            task = example(self.example, deadline=deadline)
            return task if self.human is None else task.with_human(self.human)
        from serendipity.pddl import read_agents

        if self.agent:
            pairs, team = self.pairs()
            return read_agents(pairs, team=team, human=self.human, deadline=deadline)
        return self._from_files(self.files or [], deadline)

    def pairs(self) -> tuple[dict[str, tuple[Path, Path]], tuple[Path, Path] | None]:
        """Domain and problem of each agent, and of the team.

        Raises:
            UsageError: an agent is named twice, or not by two files.
        """
        found: dict[str, tuple[Path, Path]] = {}
        for text in self.agent or []:
            name, _, files = text.partition("=")
            if not name or name in found:
                raise UsageError(f"--agent: expected NAME=DOMAIN,PROBLEM, each name once, got '{text}'")
            found[name] = _pair(files, f"--agent {name}=")
        return found, None if self.team is None else _pair(self.team, "--team ")

    def _from_files(self, files: list[Path], deadline: Deadline | None) -> Task:
        from serendipity.pddl import read_folder, read_pddl

        if len(files) == 1:
            return read_folder(files[0], human=self.human, deadline=deadline)
        domain, problem, *more = files
        if more:
            raise UsageError(f"task: expected DOMAIN PROBLEM or one folder, got {len(files)} paths")
        try:
            return read_pddl(
                domain, problem, human=self.human or "", robots=self.robot or [], deadline=deadline
            )
        except UsageError as error:
            if self.human is not None:
                raise
            raise UsageError(f"{error}; name --human H --robot R ..., in MA-PDDL --human H") from None


def _are_pair(files: list[Path] | None) -> bool:
    return files is not None and len(files) == 2


def _pair(text: str, where: str) -> tuple[Path, Path]:
    files = text.split(",")
    if len(files) != 2 or not all(files):
        raise UsageError(f"{where}: expected DOMAIN,PROBLEM, got '{text}'")
    return Path(files[0]), Path(files[1])
