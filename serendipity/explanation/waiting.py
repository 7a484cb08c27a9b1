"""Why actions begin no sooner: what of the script they wait for, or that the human's plan has it so.

Each reason is held against what would happen otherwise: an action that can't begin an epoch sooner waits for
something in the script if it could, were that an epoch sooner, or left out.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from serendipity.model import PlanStep, Result, Task, UsageError
from serendipity.model.answers.fields import Written
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.execution import variant_named

_Cause = tuple[str, str, int]
"""The last three fields of a :class:`Wait`."""

_Other = tuple[_Cause, Task]
"""A cause, and the task without it."""


@dataclass(frozen=True, slots=True)
class Wait(Written):
    """An action that begins no sooner, and why.

    Attributes:
        alone: whether it is one of the human's own plan; else of the answer's.
        why: ``fact`` or ``bystander`` (of the script), ``head-start``, or ``plan``: the human has it so,
            and nothing else.
        cause: the fact that changes (``!`` in front: it becomes false), or the bystander's action; else None.
        until: the epoch with which that is over; None for ``plan``.
    """

    action: str
    agents: tuple[str, ...]
    epoch: int
    alone: bool
    why: str
    cause: str | None = None
    until: int | None = None


def waits(task: Task, answer: Result) -> tuple[Wait, ...]:
    """What waits in the human's own plan and, where there is help, in the answer's."""
    times = answer.human_plan_times
    own = _own_steps(answer)
    plans = [_Plan(task, answer, own, times.epochs if times else len(own), alone=True)]
    if answer.opportunity and isinstance(answer.horizon, int):
        plans.append(_Plan(task, answer, answer.plan or (), answer.horizon, alone=False))
    found: dict[tuple[object, ...], Wait] = {}
    for wait in (wait for plan in plans for wait in plan.waits()):
        found.setdefault((wait.epoch, wait.action, wait.why, wait.cause), wait)
    return tuple(sorted(found.values(), key=lambda wait: (wait.epoch, wait.action)))


def _own_steps(answer: Result) -> tuple[PlanStep, ...]:
    """The human's own plan as steps."""
    names, times = answer.human_plan or (), answer.human_plan_times
    starts = range(1, len(names) + 1) if times is None else times.starts
    durations = [1] * len(names) if times is None else times.durations
    begun = zip(starts, names, durations, strict=True)
    return tuple(PlanStep(epoch, (answer.human,), name, 0, duration) for epoch, name, duration in begun)


@dataclass(frozen=True, slots=True)
class _Plan:
    """A plan beside the script, the human's own (``alone``) or an answer's."""

    task: Task
    answer: Result
    steps: Sequence[PlanStep]
    epochs: int
    alone: bool

    def waits(self) -> Iterator[Wait]:
        """What waits in it, and for what."""
        early = self.answer.options.head_start
        for step in self.steps:
            is_first = self.answer.human in step.agents and step.epoch == early + 1
            if step.epoch > 1 and self._works_sooner(step, self.task):
                if self.alone:
                    yield self._wait(step, *(("head-start", None, early) if is_first else ("plan",)))
            elif not is_first:
                for cause, task in _others(self.task, step):
                    if self._works_sooner(step, task):
                        yield self._wait(step, *cause)

    def _wait(self, step: PlanStep, why: str, cause: str | None = None, until: int | None = None) -> Wait:
        return Wait(step.action, step.agents, step.epoch, self.alone, why, cause, until)

    def _works_sooner(self, sooner: PlanStep, task: Task) -> bool:
        """Whether the plan can be done, and leads to the goal, with one step an epoch sooner."""
        steps = [replace(one, epoch=one.epoch - (one is sooner)) for one in self.steps]
        course = PlayedPlan(task.facts, task.init, task.script, strict=self.answer.options.strict)
        try:
            while course.epoch < self.epochs:
                begun = [one for one in steps if one.epoch == course.epoch + 1]
                ids = [variant_named(task, one.action, one.agents, course.state) for one in begun]
                course.begin([task.actions[i] for i in ids])
        except BrokenPlanError:
            return False
        return task.goal.holds(course.state) and (self.alone or task.robot_goal.holds(course.state))


def _others(task: Task, step: PlanStep) -> Iterator[_Other]:
    """What of the script a step may wait for, each with a task in which it is sooner, or left out."""
    script = task.script
    for fact in script.facts:
        if step.epoch - 1 <= fact.epoch < step.end:
            cause = ("fact", f"{'' if fact.true else '!'}{task.facts[fact.fact]}", fact.epoch)
            rest = tuple(one for one in script.facts if one is not fact)
            if fact.epoch == 1:
                init = task.init | {fact.fact} if fact.true else task.init - {fact.fact}
                yield from _with(task.at(init), cause, facts=rest)
            else:
                yield from _with(task, cause, facts=(*rest, replace(fact, epoch=fact.epoch - 1)))
    for deed in script.deeds:
        if step.epoch - 1 <= deed.end and deed.epoch < step.end:
            others = tuple(one for one in script.deeds if one is not deed)
            for more in ((), (replace(deed, epoch=deed.epoch - 1),)):
                yield from _with(task, ("bystander", deed.name, deed.end), deeds=(*others, *more))


def _with(task: Task, cause: _Cause, **changes: Any) -> Iterator[_Other]:
    """The task with something else in its script; none where that contradicts itself."""
    with suppress(UsageError):
        yield cause, replace(task, script=replace(task.script, **changes), known_variables=task.variables)
