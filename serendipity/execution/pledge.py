"""What is left of a plan that somebody may count on: robots go on with it while it leads to the goal."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import groupby

from serendipity.execution.advice import Advice, DecisionPoint
from serendipity.model.numbers import as_written, total
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import actions_named, variant_named
from serendipity.model.task.plans import PlanStep, Window
from serendipity.model.task.task import Task


@dataclass(frozen=True, slots=True)
class Pledge:
    """A plan that was advised before an epoch, and what the epoch was to lead to.

    Attributes:
        before: ids of the facts that were true before it.
        now: what was to be done in the epoch.
        state: ids of the facts that are true after it, if all goes as planned.
        later: what is left then, its epochs counted from there.
    """

    before: frozenset[int]
    now: tuple[PlanStep, ...]
    state: frozenset[int]
    later: Advice

    @classmethod
    def of(cls, task: Task, state: frozenset[int], advice: Advice) -> "Pledge":
        """What an advice makes of the epoch that is to come."""
        now = tuple(step for step in advice.plan if step.epoch == 1)
        rest = tuple(_moved(step for step in advice.plan if step.epoch > 1))
        window = advice.window
        if window is not None:
            window = None if window.start == 1 else Window(window.start - 1, window.end - 1)
        after = _after(task, state, now)
        assert after is not None, "what is advised is possible"
        cost = advice.cost - _cost(now)
        return cls(state, now, after, replace(advice, plan=rest, window=window, cost=cost))

    def rest(self, task: Task, now: DecisionPoint, *, mend: bool, hopeless: bool) -> Advice | None:
        """What there is to go on with; None where that does not lead to the goal any more.

        Args:
            now: from where, and without what.
            mend: the person waits for what did not take place, so the whole plan is an epoch late.
            hopeless: the person has no plan alone: robots' own goals can wait.
        """
        if self.state == now.state:
            return self.later if _goes(task, now, self.later.plan, hopeless=hopeless) else None
        if not mend:
            return None
        missed = tuple(step for step in self.now if not _done(task, step, now.state))
        if all(step.agents == (task.agents[task.human],) for step in missed):
            return None
        plan = (*missed, *_moved(self.later.plan, by=1))
        if not _goes(task, now, plan, hopeless=hopeless):
            return None
        return replace(self.later, plan=plan, window=None, cost=self.later.cost + _cost(missed), proved=False)


def _goes(task: Task, now: DecisionPoint, plan: Sequence[PlanStep], *, hopeless: bool) -> bool:
    """Whether a plan leads to the goals from where things stand, by those who are at hand."""
    state: frozenset[int] | None = now.state
    for epoch, group in groupby(sorted(plan, key=_epoch), _epoch):
        steps = list(group)
        barred = now.barred - now.running if epoch == 1 else now.out
        if any(barred.issuperset(actions_named(task, step.action, step.agents)) for step in steps):
            return False
        state = None if state is None else _after(task, state, steps)
    if state is None or not task.goal.holds(state):
        return False
    return hopeless or task.robot_goal.holds(state)


def _after(task: Task, state: frozenset[int], steps: Iterable[PlanStep]) -> frozenset[int] | None:
    """The state after the steps of an epoch; None where one of them is not possible."""
    chosen = []
    for step in steps:
        action = task.actions[variant_named(task, step.action, step.agents, state)]
        if not action.applicable(state):
            return None
        chosen.append(action)
    return apply(state, *chosen)


def _done(task: Task, step: PlanStep, state: frozenset[int]) -> bool:
    """Whether a state shows what a step leads to."""
    same = (task.actions[i] for i in actions_named(task, step.action, step.agents))
    return any(state.issuperset(a.add) and state.isdisjoint(set(a.delete).difference(a.add)) for a in same)


def _moved(steps: Iterable[PlanStep], by: int = -1) -> Iterator[PlanStep]:
    return (replace(step, epoch=step.epoch + by) for step in steps)


def _cost(steps: Iterable[PlanStep]) -> Fraction:
    return total(as_written(step.cost) for step in steps)


def _epoch(step: PlanStep) -> int:
    return step.epoch
