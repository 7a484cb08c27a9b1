"""How a command line names a task: two files, one pair per agent, a folder, or an example."""

import sys
from inspect import Parameter
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from serendipity.cli.choices import option
from serendipity.cli.files.reading import read_json
from serendipity.cli.groups import OptionGroup
from serendipity.cli.options import limits, settings
from serendipity.cli.streams import output, progress
from serendipity.model import Deadline, Result, Script, Task, UsageError
from serendipity.model.keywords import ANYBODY, Interference
from serendipity.model.printable import message
from serendipity.model.task.names import canonical_name
from serendipity.model.task.plans_in_time import broken_script


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


_LENGTH_HELP: Final = "How long an epoch is, in the unit of durations; by default found out."

LENGTH: Final = Parameter(
    "epoch_length",
    Parameter.KEYWORD_ONLY,
    default=None,
    annotation=Annotated[str | None, option("--epoch-length X", _LENGTH_HELP)],
)
"""``--epoch`` of a command that has another option of that name."""


class TaskName(OptionGroup):
    """The words that name a task; exactly one of the four ways."""

    files: Files = None
    human: Annotated[
        str | None,
        option(
            "--human H|any",
            "The human; by default the only agent with a goal. 'any' (`plan`): whoever can be helped best.",
        ),
    ] = None
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
    bystander: Annotated[
        list[str] | None,
        option(
            "--bystander NAME|NAME=FILE",
            "Somebody who does what is best for them, or what the plan in FILE says (repeat it).",
        ),
    ] = None
    epoch_length: Annotated[str | None, option("--epoch X", _LENGTH_HELP)] = None
    example: Annotated[
        str | None, option("--example NAME", "A task that is shipped.", autocompletion=_examples)
    ] = None

    def load(
        self,
        deadline: Deadline | None = None,
        *,
        interference: Interference = "paper",
        anybody: bool = False,
    ) -> Task:
        """The task, with its warnings on stderr.

        Args:
            deadline: of reading it, and of predicting bystanders.
            interference: of what bystanders may do at once.
            anybody: whether the human may be whoever can be helped best; the task has one of them, then.

        Raises:
            UsageError: no way of naming a task, two at once, or half of one.
            InputError: a file can't be read or understood.
            LimitReachedError: the deadline ran out.
        """
        named = self.settled()
        task = named.read(deadline, interference=interference)
        if named.for_anybody and not anybody and ANYBODY not in task.agents:
            raise UsageError("--human any: goes with `plan` only, whose answer says who is helped")
        output.warn(*task.warnings)
        return task

    def with_result(self, command: str, deadline: Deadline | None = None) -> tuple[Task, Path, Result]:
        """The task of all files but the last, which is that of a result; that file; the result."""
        *named, answer = self.files or []
        if answer.suffix == ".pddl" or answer.is_dir():
            raise UsageError(f"{command}: expected TASK and then RESULT.json, got {answer} last")
        result = Result.from_dict(read_json(answer), answer)
        task = self.but(files=named).load(deadline, interference=result.options.interference)
        return task, answer, result

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

    def read(self, deadline: Deadline | None = None, *, interference: Interference = "paper") -> Task:
        """The task that these very words name; errors as for :meth:`load`."""
        with progress.working("reading"), limits.during("reading the task"):
            self._check()
            return self._beside_others(self._of_files(deadline), deadline, interference)

    def _check(self) -> None:
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

    def _of_files(self, deadline: Deadline | None) -> Task:
        """The task without bystanders of the command line."""
        how: dict[str, Any] = {"epoch": self.epoch_length, "deadline": deadline}
        if self.example is not None:
            from serendipity.scenarios.examples import example

            task = example(self.example, **how)
            return task if self.human is None else task.with_human(self.human)
        from serendipity.pddl import ALL, read_agents, read_folder, read_pddl

        if self.agent:
            pairs, team = self.pairs()
            return read_agents(pairs, team=team, human=self.human, **how)
        files = self.files or []
        if len(files) == 1:
            return read_folder(files[0], human=self.human, **how)
        domain, problem, *more = files
        if more:
            raise UsageError(f"task: expected DOMAIN PROBLEM or one folder, got {len(files)} paths")
        robots = [*(self.robot or ())]
        if robots and robots != [ALL]:  # bystanders are agents, too
            known = {*map(canonical_name, robots), canonical_name(self.human or "")}
            robots += [name for name, _ in self._people() if name not in known]
        try:
            return read_pddl(domain, problem, human=self.human or "", robots=robots, **how)
        except UsageError as error:
            if self.human is not None:
                raise
            named = "name --human H (`execute`: --person H) and --robot R ..., in MA-PDDL the human"
            raise UsageError(f"{error}; {named}") from None

    def _beside_others(self, task: Task, deadline: Deadline | None, interference: Interference) -> Task:
        """The task with bystanders, those whose plans are given first."""
        people = self._people()
        if not people:
            return task
        from serendipity.cli.files.plans import bystanders_plan
        from serendipity.facade.bystanders import helping_another, with_bystanders

        if self.for_anybody:
            task = helping_another(task, [name for name, _ in people])
        plans = {name: bystanders_plan(file, task, name) for name, file in people if file is not None}
        if plans:
            task = task.with_script(Script(people=plans))
            broken = broken_script(task, strict=interference == "strict")
            if broken is not None:
                output.warn(f"--bystander: while all others are idle, {broken}")
        predicted = [name for name, file in people if file is None]
        return with_bystanders(task, predicted, interference=interference, deadline=deadline)

    def _people(self) -> list[tuple[str, Path | None]]:
        """The names of bystanders, each with the file of their plan or None."""
        given = [text.partition("=") for text in self.bystander or ()]
        found = [(canonical_name(name), Path(file) if equals else None) for name, equals, file in given]
        if any(equals and not file for _, equals, file in given):
            raise UsageError("--bystander: expected NAME or NAME=FILE, got no file after '='")
        if len(dict(found)) < len(found):
            raise UsageError("--bystander: expected each name once")
        return found

    @property
    def for_anybody(self) -> bool:
        """Whether it says that whoever can be helped best is the human."""
        return self.human is not None and canonical_name(self.human) == ANYBODY

    def pairs(self) -> tuple[dict[str, tuple[Path, Path]], tuple[Path, Path] | None]:
        """Domain and problem of each agent, and of the team."""
        found: dict[str, tuple[Path, Path]] = {}
        for text in self.agent or []:
            name, _, files = text.partition("=")
            if not name or name in found:
                raise UsageError(f"--agent: expected NAME=DOMAIN,PROBLEM, each name once, got '{text}'")
            found[name] = _pair(files, f"--agent {name}=")
        return found, None if self.team is None else _pair(self.team, "--team ")


def _are_pair(files: list[Path] | None) -> bool:
    return files is not None and len(files) == 2


def _pair(text: str, where: str) -> tuple[Path, Path]:
    files = text.split(",")
    if len(files) != 2 or not all(files):
        raise UsageError(f"{where}: expected DOMAIN,PROBLEM, got '{text}'")
    return Path(files[0]), Path(files[1])
