"""Advice through a session: for people who are told or omniscient, and for robots with goals of their own."""

from dataclasses import replace

from serendipity.execution.advice import Advice, DecisionPoint
from serendipity.execution.guard import Following, RobotActions
from serendipity.execution.pledge import Pledge
from serendipity.execution.sessions import RestrictedSessions
from serendipity.model.answers.result import Result
from serendipity.model.errors import LIMITS, LimitReachedError
from serendipity.model.numbers import as_written, total
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.execution import variant_named
from serendipity.model.task.task import Task


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
        self._beside = RestrictedSessions(task, **common, mode=options.mode, human_model=options.human_model)
        free = task.with_goal(task.goal, Condition())  # robots' own goals can wait
        self._joint = RestrictedSessions(free, **common, mode="composite", horizon=INFINITE)
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
            return None
        sessions = self._joint if hopeless else self._beside
        session = sessions.without(removed)
        if pledge is not None and (pledge.before, pledge.state) == (session.task.init, now.state):
            done = [step.action for step in pledge.now]
            if all(action in session.task.named for action in done):
                session.execute(done)
        session = sessions.at(now.state, removed)
        session.follow(None if hopeless else [self._task.actions[i].name for i in promise])
        return self._answered(session.plan(deadline=deadline), hopeless=hopeless)

    def _answered(self, result: Result, *, hopeless: bool) -> Advice | None:
        if result.plan is None:
            if result.status == "unknown":
                raise LimitReachedError("time-limit")
            return None
        cost = total(as_written(step.cost) for step in result.plan)
        pays = hopeless or result.opportunity
        return Advice(result.plan, result.window, cost, pays, result.status == "optimal")
