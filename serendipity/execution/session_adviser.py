"""Advice through a session: for people who are told or omniscient, and for robots with goals of their own."""

from collections import OrderedDict
from copy import copy
from dataclasses import replace
from typing import Any, Final

from serendipity.execution.advice import Advice, Question, without
from serendipity.execution.guard import Hands
from serendipity.execution.pledge import Pledge
from serendipity.facade.session import Session
from serendipity.model.answers.result import Result
from serendipity.model.errors import LIMITS, LimitReachedError
from serendipity.model.numbers import as_written, total
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.execution import variant_named
from serendipity.model.task.task import Task

_MOST: Final = 3
"""Sessions at once: what is to be left alone changes seldom, and goes back and forth."""

_Asked = tuple[frozenset[int], bool]
"""What a session is for: actions that are left out, and whether the person can't do it alone."""


class SessionAdviser:
    """Plans for one goal of the person's.

    What was advised is finished: it is given up only for what costs less, or where it can't be.  Where
    the person has no plan alone, everybody's cheapest plan is asked for, whatever came before: that is how
    help is finished that was interrupted, and how what was taken is given back.

    Args:
        task: the task with that goal.
        options: of the planning calls.
        hands: what robots can do.
        told: the person keeps to the robots' plan: nothing has to be left alone.
    """

    def __init__(self, task: Task, options: Options, hands: Hands, *, told: bool) -> None:
        self._task = task
        self._hands = hands
        self._told = told
        common = {"discount": options.discount, "interference": options.interference}
        self._alone: dict[str, Any] = {
            **common,
            "mode": options.mode,
            "human_model": options.human_model,
        }
        self._joint: dict[str, Any] = {**common, "mode": "composite", "horizon": INFINITE}
        self._sessions: OrderedDict[_Asked, Session] = OrderedDict()
        self._pledges: dict[frozenset[int], Pledge] = {}

    def advise(self, question: Question, deadline: Deadline) -> Advice | None:
        """See :class:`serendipity.execution.advice.Adviser`; what plans need is never touched."""
        removed = question.barred
        if not self._told:
            removed |= self._hands.off(question.following.needed())
        while True:
            advice = self._best(question, removed, deadline)
            if advice is None:
                return None
            first = (step for step in advice.plan if step.epoch == 1)
            now = [variant_named(self._task, step.action, step.agents, question.state) for step in first]
            robots = [i for i in now if self._task.actions[i].participants != (self._task.human,)]
            if question.allows(robots):
                return advice
            removed |= {robots[0]}

    def again(self) -> "SessionAdviser":
        """See :class:`serendipity.execution.advice.Adviser`."""
        other = copy(self)
        other._pledges = dict(self._pledges)
        return other

    def _best(self, question: Question, removed: frozenset[int], deadline: Deadline) -> Advice | None:
        """What is cheapest of what was advised before and what is found now."""
        key = frozenset() if self._told else removed
        pledge = self._pledges.get(key)
        rest = None if pledge is None else pledge.rest(self._task, question, mend=self._told)
        alone = question.following.alone
        own_goals = bool(self._task.robot_goal)  # then what is left may be for these alone
        if rest is not None and alone is not None and rest.cost >= alone and not own_goals:
            rest = rest if rest.by_themselves(self._task) else None
        best = rest
        if rest is None or not (rest.proved or alone is None) or own_goals:
            try:
                found = self._asked(question, removed, pledge, deadline)
            except LIMITS:
                if rest is None:
                    raise
            else:
                if rest is None or (found is not None and found.cost < rest.cost):
                    best = found
                elif found is not None and found.cost == rest.cost:
                    best = found if own_goals else replace(rest, proved=found.proved)
        if best is None:
            self._pledges.pop(key, None)
        else:
            self._pledges[key] = Pledge.of(self._task, question.state, best)
        return best

    def _asked(
        self, question: Question, removed: frozenset[int], pledge: Pledge | None, deadline: Deadline
    ) -> Advice | None:
        hopeless = question.following.hopeless
        promise = question.following.promise()
        if not promise and not hopeless:
            return None
        session = self._session(removed, hopeless=hopeless)
        as_planned = pledge is not None and pledge.state == question.state
        known = pledge is not None and all(step.action in session.task.named for step in pledge.now)
        if pledge is not None and as_planned and known and pledge.before == session.task.init:
            session.execute([step.action for step in pledge.now])
        changed = session.task.init ^ question.state
        session.change({self._task.facts[fact]: fact in question.state for fact in sorted(changed)})
        session.follow(None if hopeless else [self._task.actions[i].name for i in promise])
        return self._answered(session.plan(deadline=deadline), hopeless=hopeless)

    def _answered(self, result: Result, *, hopeless: bool) -> Advice | None:
        if result.plan is None:
            if result.status == "unknown":
                raise LimitReachedError("time-limit")
            return None
        cost = total(as_written(step.cost) for step in result.plan)
        return Advice(
            result.plan, result.window, cost, hopeless or result.opportunity, result.status == "optimal"
        )

    def _session(self, removed: frozenset[int], *, hopeless: bool) -> Session:
        key = (removed, hopeless)
        session = self._sessions.get(key)
        if session is None:
            task, options = without(self._task, removed), self._alone
            if hopeless:  # robots' own goals can wait
                task, options = task.with_goal(task.goal, Condition()), self._joint
            session = self._sessions[key] = Session(task, **options)
            if len(self._sessions) > _MOST:
                self._sessions.popitem(last=False)
        self._sessions.move_to_end(key)
        return session
