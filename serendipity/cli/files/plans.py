"""Plans as files: that of ``--human-plan``, and those of the planning competitions."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Final

from serendipity.cli.files.reading import read_text
from serendipity.model import InputError, PlanError, PlanStep, Result, Script, Task, UsageError
from serendipity.model.numbers import plain
from serendipity.model.printable import printable
from serendipity.model.task.actions import NOOP, in_turn
from serendipity.model.task.plans import PlanEntry
from serendipity.model.telling import team
from serendipity.pddl.parsing.timed_plans import PlanLine, entries, plan_lines, timed_line

_PLAN: Final = "human plan: "


def timed_plan(path: Path, task: Task, head_start: int = 0) -> tuple[PlanEntry, ...]:
    """The human's plan in a file, behind a head start; waiting is part of it where actions have times.

    Raises:
        InputError: ``file:line`` and what was expected.
        PlanError: ``file:line`` and the first action that is wrong in the task, or the goal missed.
    """
    lines = _actions_in(path, _PLAN)
    listed = entries(lines, task, path, _PLAN)
    try:
        task.plan_from_names(listed, head_start)
    except PlanError as error:
        line = None if error.step is None else lines[error.step - 1].line
        raise PlanError(error.message, path, line) from None
    return tuple(listed)


def bystanders_plan(path: Path, task: Task, person: str) -> tuple[PlanEntry, ...]:
    """The plan of a bystander in a file; waiting is part of it where actions have times.

    Raises:
        InputError: ``file:line`` and what was expected.
        UsageError: that person can't be a bystander.
    """
    what = f"plan of {person}: "
    lines = _actions_in(path, what)
    listed = entries(lines, task, path, what)
    if _wrong_in_script(task, person, listed):
        for number, line in enumerate(lines, start=1):
            wrong = _wrong_in_script(task, person, listed[:number])
            if wrong:
                raise InputError(what + wrong, path, line.line)
    return tuple(listed)


def _wrong_in_script(task: Task, person: str, plan: Sequence[PlanEntry]) -> str:
    """What is wrong with a bystander's plan, other than that person; nothing where all is well."""
    task.with_script(Script(people={person: ()}))
    try:
        task.with_script(Script(people={person: plan}))
    except UsageError as error:
        return str(error).removeprefix("script: ")
    return ""


def _actions_in(path: Path, what: str) -> list[PlanLine]:
    found = [one._replace(name=one.name.strip()) for one in plan_lines(read_text(path), path, what)]
    return [one for one in found if one.timed or one.name.lower() not in ("", "noop")]


def plan_file(task: Task, result: Result) -> str:
    """A plan, epoch by epoch: ``(move commx room13 hall8)``, comments apart.

    Within an epoch an action comes before those that would undo what it needs, so that the
    lines can also be executed one after another; a comment says where no order does.  In time
    each line says when it begins and how long it takes: ``12.000: (walk ann bed sink) [4.000]``.
    """
    return "".join(f"{line}\n" for line in _lines(task, result))


def _lines(task: Task, result: Result) -> Iterator[str]:
    robots = [task.agents[i] for i in task.robots]
    yield f"; {printable(f'{task.name}: {team(result.human, robots)}')}"
    steps = sorted(result.plan or (), key=lambda step: step.epoch)
    in_time = task.needs_time or result.in_time
    yield from _timed_lines(task, result, steps) if in_time else _lines_by_epoch(task, steps)
    yield f"; cost = {plain(result.cost)} (general cost)"


def _timed_lines(task: Task, result: Result, steps: list[PlanStep]) -> Iterator[str]:
    """The lines of a plan in time; a last ``noop`` says until when the human waits, if nobody else acts."""
    for who, theirs in result.bystanders.items():
        yield from (f"; {who}: {timed_line(task, s.epoch, s.action, s.duration)}" for s in theirs)
    yield from (timed_line(task, s.epoch, s.action, s.duration) for s in steps)
    times, over = result.human_plan_times, max((step.end for step in steps), default=0)
    if times is None or any(step.agents != (result.human,) for step in steps):
        return
    is_theirs = [(step.epoch, step.action) for step in steps] == [
        *zip(times.starts, result.human_plan or (), strict=True)
    ]
    until = times.epochs if is_theirs or result.mode == "individual" else result.horizon
    if isinstance(until, int) and until > over:
        yield timed_line(task, until, NOOP, 1)


def _lines_by_epoch(task: Task, steps: list[PlanStep]) -> Iterator[str]:
    for epoch, group in groupby(steps, key=lambda step: step.epoch):
        yield f"; epoch {epoch}"
        yield from _ordered(task, list(group))


def _ordered(task: Task, steps: list[PlanStep]) -> Iterator[str]:
    variants = [[task.actions[i] for i in task.named.get(step.action, ())] for step in steps]
    ordered, together = in_turn(variants)
    yield from (f"({steps[i].action})" for i in ordered)
    if together:
        yield "; the next actions only work at the same time"
        yield from (f"({steps[i].action})" for i in together)
