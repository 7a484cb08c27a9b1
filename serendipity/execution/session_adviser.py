"""Advice through sessions: for people who are told or omniscient, and for robots with goals of their own.

What was advised is pledged: robots go on with it while it leads to the goal, since somebody may count on it.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import groupby
from typing import Any, Final

from serendipity.execution.advice import Advice, DecisionPoint
from serendipity.execution.guard import Following, RobotActions
from serendipity.facade.session import Session
from serendipity.model import INFINITE, Condition, Deadline, Options, PlanStep, Result, Task, Window
from serendipity.model.errors import LIMITS, LimitReachedError
from serendipity.model.numbers import as_written, total
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import actions_named, variant_named
from serendipity.model.task.script import Timeline


@dataclass(frozen=True, slots=True)
class Pledge:
    """A plan that was advised before an epoch, and what the epoch was to lead to.

    Attributes:
        before: ids of the facts that were true before it.
        now: what was to be done in the epoch.
        state: ids of the facts that are true after it, if all goes as planned.
        later: what is left then, its epochs counted from there.
        script: in time, what is left of it then, and what goes on; None without, and where it is not known.
    """

    before: frozenset[int]
    now: tuple[PlanStep, ...]
    state: frozenset[int]
    later: Advice
    script: Timeline | None = None

    def stands(self, now: Task) -> bool:
        """Whether a task as it stands, in time, is what the epoch was to lead to."""
        return (self.state, self.script) == (now.init, now.script)

    @classmethod
    def of(cls, task: Task, state: frozenset[int], advice: Advice) -> "Pledge":
        """What an advice makes of the epoch that is to come."""
        now = tuple(step for step in advice.plan if step.epoch == 1)
        rest = tuple(moved(step for step in advice.plan if step.epoch > 1))
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
        plan = (*missed, *moved(self.later.plan, by=1))
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


def moved(steps: Iterable[PlanStep], by: int = -1) -> Iterator[PlanStep]:
    """Steps so many epochs later."""
    return (replace(step, epoch=step.epoch + by) for step in steps)


def _cost(steps: Iterable[PlanStep]) -> Fraction:
    return total(as_written(step.cost) for step in steps)


def _epoch(step: PlanStep) -> int:
    return step.epoch


_MOST: Final = 3
"""Sessions at once: what is to be left alone changes seldom, and goes back and forth."""


class RestrictedSessions:
    """Sessions of a task under some options, by the actions that are left out; the last few are kept."""

    def __init__(self, task: Task, **options: Any) -> None:
        self._task = task
        self._options = options
        self._kept: dict[frozenset[int], Session] = {}

    def without(self, removed: frozenset[int]) -> Session:
        """The session without some actions, by their ids, where it was left."""
        session = self._kept.pop(removed, None)
        if session is None:
            kept = tuple(action for i, action in enumerate(self._task.actions) if i not in removed)
            task = replace(self._task, actions=kept, known_variables=self._task.variables)
            session = Session(task if removed else self._task, **self._options)
        self._kept[removed] = session
        if len(self._kept) > _MOST:
            del self._kept[next(iter(self._kept))]
        return session

    def at(self, state: frozenset[int], removed: frozenset[int]) -> Session:
        """The same, in a state."""
        session = self.without(removed)
        changed = session.task.init ^ state
        session.change({self._task.facts[fact]: fact in state for fact in sorted(changed)})
        return session


class SessionAdviser:
    """Plans for one goal of the person's.

    What was advised is finished: it is given up only for what costs less, or where it can't be.  Where
    the person has no plan alone, everybody's cheapest plan is asked for, whatever came before: that is how
    help is finished that was interrupted, and how what was taken is given back.

    Args:
        actions: what robots can do.
        told: the person keeps to the robots' plan: nothing has to be left alone.
    """

    def __init__(self, task: Task, options: Options, actions: RobotActions, *, told: bool) -> None:
        self._task = task
        self._actions = actions
        self._told = told
        common = {"discount": options.discount, "interference": options.interference}
        self._beside = RestrictedSessions(
            task,
            **common,
            mode=options.mode,
            human_model=options.human_model,
            window_weight=options.window_weight,
        )
        free = task.with_goal(task.goal, Condition())  # robots' own goals can wait
        self._joint = RestrictedSessions(free, **common, mode="composite", horizon=INFINITE)
        self._own = RestrictedSessions(task, **common, mode="composite", horizon=INFINITE)
        self._theirs = frozenset(i for i, a in enumerate(task.actions) if task.human in a.participants)
        self._pledges: dict[frozenset[int], Pledge] = {}

    def advise(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Advice | None:
        """See :class:`.advice.Adviser`; what plans need is never touched."""
        removed = now.barred
        if not self._told:
            removed |= self._actions.spoiling(following.needed())
        while True:
            advice = self._best(following, now, removed, deadline)
            if advice is None:
                return None
            first = (step for step in advice.plan if step.epoch == 1)
            chosen = [variant_named(self._task, step.action, step.agents, now.state) for step in first]
            robots = [i for i in chosen if self._task.actions[i].participants != (self._task.human,)]
            if now.allows(robots):
                return advice
            removed |= {robots[0]}

    def _best(
        self, following: Following, now: DecisionPoint, removed: frozenset[int], deadline: Deadline
    ) -> Advice | None:
        """What is cheapest of what was advised before and what is found now."""
        key = frozenset() if self._told else removed
        pledge = self._pledges.get(key)
        alone, hopeless = following.alone, following.hopeless
        rest = None if pledge is None else pledge.rest(self._task, now, mend=self._told, hopeless=hopeless)
        own_goals = bool(self._task.robot_goal)  # then what is left may be for these alone
        if rest is not None and alone is not None and rest.cost >= alone and not own_goals:
            rest = rest if rest.by_themselves(self._task) else None
        best = rest
        if rest is None or not (rest.proved or alone is None) or own_goals:
            try:
                found = self._asked(following, now, removed, pledge, deadline)
            except LIMITS:
                if rest is None:
                    raise
            else:
                if rest is None or (found is not None and found.cost < rest.cost):
                    best = found
                elif found is not None and found.cost == rest.cost:
                    best = found if own_goals else replace(rest, proved=found.proved)
        made = {} if best is None else {key: Pledge.of(self._task, now.state, best)}
        self._pledges = {other: known for other, known in self._pledges.items() if other != key} | made
        return best

    def _asked(
        self,
        following: Following,
        now: DecisionPoint,
        removed: frozenset[int],
        pledge: Pledge | None,
        deadline: Deadline,
    ) -> Advice | None:
        hopeless, promise = following.hopeless, following.promise()
        if not promise and not hopeless:
            return self._afterwards(now, removed, deadline)
        sessions = self._joint if hopeless else self._beside
        session = sessions.without(removed)
        if pledge is not None and (pledge.before, pledge.state) == (session.task.init, now.state):
            done = [step.action for step in pledge.now]
            if all(action in session.task.named for action in done):
                session.execute(done)
        session = sessions.at(now.state, removed)
        session.follow(None if hopeless else [self._task.actions[i].name for i in promise])
        return self._answered(session.plan(deadline=deadline), hopeless=hopeless)

    def _afterwards(self, now: DecisionPoint, removed: frozenset[int], deadline: Deadline) -> Advice | None:
        """What robots have still to do where the person has what they want."""
        if self._task.robot_goal.holds(now.state) or not self._task.goal.holds(now.state):
            return None
        session = self._own.at(now.state, removed | self._theirs)
        advice = self._answered(session.plan(deadline=deadline), hopeless=True)
        return None if advice is None else replace(advice, pays=False)

    def _answered(self, result: Result, *, hopeless: bool) -> Advice | None:
        if result.plan is None:
            if result.status == "unknown":
                raise LimitReachedError("time-limit")
            return None
        cost = total(as_written(step.cost) for step in result.plan)
        pays = hopeless or result.opportunity
        return Advice(result.plan, result.window, cost, pays, result.status == "optimal")
