"""The facade of the lint: a task, and the files it was read from, to a report."""

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import chain
from os import PathLike

from serendipity.lint.file_rules import file_findings
from serendipity.lint.report import LEVELS, Finding, TaskReport, TaskTime
from serendipity.lint.script_rules import script_findings
from serendipity.lint.task_rules import task_findings
from serendipity.model import Deadline, GroundAction, Task
from serendipity.model.arguments import DEADLINE, LIST, PAIR, TASK_IN_TIME, expect, expect_or_none
from serendipity.model.errors import UsageError
from serendipity.model.task.horizon import require_few_epochs
from serendipity.pddl.parsing.files import read_unit
from serendipity.pddl.work import Work

Files = Iterable[tuple[str | PathLike[str], str | PathLike[str]]]


def check_task(task: Task, files: Files = (), *, deadline: Deadline | None = None) -> TaskReport:
    """Look for what is wrong with a task, or is probably not meant: nothing is planned.

    Args:
        task: the task.
        files: domain and problem of each pair of PDDL files that it was read from.  Without
            them, what only files show is left out: names that nothing uses, requirements.
        deadline: when to give up; None for no limit.

    Returns:
        How large the task is, and the findings.  Where one has the level ``error`` the task
        can't be right: a goal is out of everybody's reach.

    Raises:
        InputError: a file can't be read or is wrong.
        LimitReachedError: a limit came first.
    """
    expect(TASK_IN_TIME, task=task)
    expect(LIST, files=files)
    expect_or_none(DEADLINE, deadline=deadline)
    limits = deadline or Deadline()
    work = Work(limits)
    pairs = list(files)
    expect(PAIR, **{f"files, pair {number}": pair for number, pair in enumerate(pairs, start=1)})
    units = [read_unit(None, domain, problem, work) for domain, problem in pairs]
    found = chain(
        task_findings(task, limits),
        _too_long(task),
        script_findings(task, limits) if task.script else (),
        file_findings(task, units) if units else (),
    )
    return TaskReport(
        task=task.name,
        human=task.agents[task.human],
        agents={
            name: sum(agent in action.participants for action in limits.each(task.actions))
            for agent, name in enumerate(task.agents)
        },
        facts=len(task.facts),
        variables=len(task.variables),
        actions=dict(Counter(_origin(task, action) for action in limits.each(task.actions)).most_common()),
        findings=_sorted(found),
        time=_time(task) if task.needs_time or task.script.people else None,
    )


def _too_long(task: Task) -> Iterator[Finding]:
    try:
        require_few_epochs(task)
    except UsageError as error:
        yield Finding("warning", "too-many-epochs", f"not planned for: {error}")


def _time(task: Task) -> TaskTime:
    script = task.script
    counts = Counter(deed.agent for deed in script.deeds)
    return TaskTime(
        epoch=task.epoch,
        longest=max((action.duration for action in task.actions), default=1),
        script_epochs=script.last,
        script_facts=len(script.facts),
        bystanders={task.agents[agent]: counts[agent] for agent in sorted(script.people)},
    )


def _sorted(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    by_rule: dict[tuple[str, str], Finding] = {}
    for finding in findings:
        by_rule.setdefault((finding.rule, finding.text), finding)
    return tuple(sorted(by_rule.values(), key=lambda finding: LEVELS.index(finding.level)))


def _origin(task: Task, action: GroundAction) -> str:
    """The PDDL action of a ground one; of names without arguments what comes before the agents."""
    first, *arguments = action.key
    if arguments:
        return first
    parts = first.split("_")
    agents = {part for i in action.participants for part in task.agents[i].split("_")}
    verb = [
        part for part in parts[: next((i for i, p in enumerate(parts) if p in agents), len(parts))] if part
    ]
    return "_".join(verb) or first
