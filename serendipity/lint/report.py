"""Findings about a task, and their JSON form (schema ``serendipity.task-report/1``)."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from serendipity.model.answers.fields import Written, written
from serendipity.model.numbers import plain
from serendipity.model.telling import Grid, Line, Output

SCHEMA: Final = "serendipity.task-report/1"
LEVELS: Final = ("error", "warning", "note")
"""The task can't be right; it is probably not what was meant; it may well be meant so."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that the author of a task should look at.

    Attributes:
        level: one of ``LEVELS``.
        rule: what was looked for, such as ``goal-unreachable``.
        text: one line for people.
    """

    level: str
    rule: str
    text: str


@dataclass(frozen=True, slots=True)
class TaskTime(Written):
    """The time in a task (semantics 10).

    Attributes:
        epoch: how long an epoch is, in the unit of PDDL's durations.
        longest: epochs of the longest action.
        script_epochs: epochs until the script ends; 0 without one.
        script_facts: facts that it changes, each time counted.
        bystanders: for each how many actions their plan has.
    """

    epoch: Fraction
    longest: int
    script_epochs: int
    script_facts: int
    bystanders: dict[str, int]

    def told(self) -> Iterator[Line]:
        """The lines of it."""
        longest = f"{self.longest:,} epoch{'s' * (self.longest != 1)}"
        yield Line(f"an epoch is {plain(self.epoch)} long, the longest action takes {longest}")
        if self.script_epochs:
            facts = f"{self.script_facts} change{'s' * (self.script_facts != 1)} of facts"
            yield Line(f"script: {facts}, until epoch {self.script_epochs:,}")
        for name, count in self.bystanders.items():
            yield Line(f"bystander {name}: {count} action{'s' * (count != 1)}")


@dataclass(frozen=True, slots=True, repr=False)
class TaskReport(Output):
    """The size of a task, and the findings about it.

    Attributes:
        agents: for each agent how many ground actions it takes part in.
        facts: how many there are after grounding.
        variables: how many finite-domain variables they make.
        actions: how many ground actions come from each action of the PDDL files.
        findings: errors first.
        time: that in it; None where each action takes one epoch, and nothing happens by a script.
    """

    task: str
    human: str
    agents: dict[str, int]
    facts: int
    variables: int
    actions: dict[str, int]
    findings: tuple[Finding, ...]
    time: TaskTime | None = None

    @property
    def right(self) -> bool:
        """Whether nothing says that the task can't be right."""
        return all(finding.level != "error" for finding in self.findings)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        found = {"schema": SCHEMA, **written(self)}
        return found if self.time is not None else {k: v for k, v in found.items() if k != "time"}

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``check-task`` prints."""
        yield Line(f"{self.task}: human {self.human}; {self.facts} facts in {self.variables} variables")
        if self.time is not None:
            yield from self.time.told()
        yield Line()
        counts = [(name, str(count)) for name, count in self.actions.items()]
        yield Grid(("action", "ground actions"), [*counts, ("all", str(sum(self.actions.values())))])
        yield Line()
        yield Grid(("agent", "takes part in"), [(name, str(count)) for name, count in self.agents.items()])
        yield Line()
        styles = {"error": "bold red", "warning": "yellow", "note": ""}
        for finding in self.findings:
            yield Line(f"{finding.level}: {finding.text} ({finding.rule})", styles[finding.level])
        if not self.findings:
            yield Line("nothing wrong was found", "green")

    def _in_short(self) -> Iterator[str]:
        yield repr(self.task)
        for level in LEVELS:
            yield f"{sum(finding.level == level for finding in self.findings)} {level}s"
