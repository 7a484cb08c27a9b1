"""What is found about a task, and its JSON form (schema ``serendipity.task-report/1``)."""

from dataclasses import asdict, dataclass
from typing import Any, Final

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
class TaskReport:
    """How large a task is, and what is found about it.

    Attributes:
        task: its name.
        human: the human's name.
        agents: for each agent how many ground actions it takes part in.
        facts: how many there are after grounding.
        variables: how many finite-domain variables they make.
        actions: how many ground actions come from each action of the PDDL files.
        findings: errors first.
    """

    task: str
    human: str
    agents: dict[str, int]
    facts: int
    variables: int
    actions: dict[str, int]
    findings: tuple[Finding, ...]

    @property
    def right(self) -> bool:
        """Whether nothing says that the task can't be right."""
        return all(finding.level != "error" for finding in self.findings)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        values = asdict(self)
        return {"schema": SCHEMA, **values, "findings": [asdict(finding) for finding in self.findings]}
