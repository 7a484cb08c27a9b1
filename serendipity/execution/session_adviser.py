"""Advice through a session: for people who are told or omniscient, and for robots with goals of their own."""

from collections import OrderedDict
from copy import copy
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

from serendipity.execution.advice import Advice, Question
from serendipity.execution.guard import Hands
from serendipity.facade.session import Session
from serendipity.model.answers.result import Result
from serendipity.model.numbers import as_written
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import actions_named
from serendipity.model.task.plans import PlanStep, Window
from serendipity.model.task.task import Task

_MOST: Final = 3
"""Sessions at once: what is to be left alone changes seldom, and goes back and forth."""


class SessionAdviser:
    """Plans for one goal of the person's.

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
        self._options: dict[str, Any] = {
            "mode": options.mode,
            "discount": options.discount,
            "human_model": options.human_model,
            "interference": options.interference,
        }
        self._sessions: OrderedDict[frozenset[int], Session] = OrderedDict()
        self._kept: dict[frozenset[int], tuple[frozenset[int], Result]] = {}

    def advise(self, question: Question, deadline: Deadline) -> Advice | None:
        """See :class:`serendipity.execution.advice.Adviser`; what plans need is never touched."""
        removed = question.barred
        if not self._told:
            removed |= self._hands.off(question.following.needed())
        while True:
            result = self._best(question, removed, deadline)
            if result is None or result.plan is None:
                return None
            now = [self._ids(step, question.state) for step in result.plan if step.epoch == 1]
            robots = [i for i in now if self._task.actions[i].participants != (self._task.human,)]
            if question.allows(robots):
                cost = sum((as_written(step.cost) for step in result.plan), Fraction(0))
                proved = result.status == "optimal"
                return Advice(result.plan, result.window, cost, result.opportunity, proved)
            removed |= {robots[0]}

    def again(self) -> "SessionAdviser":
        """See :class:`serendipity.execution.advice.Adviser`."""
        other = copy(self)
        other._kept = dict(self._kept)
        return other

    def _best(self, question: Question, removed: frozenset[int], deadline: Deadline) -> Result | None:
        promise = question.following.promise()
        if not promise:
            return None
        kept = self._kept.get(removed)
        if kept is None or kept[0] != question.state:
            session = self._session(removed)
            changed = session.task.init ^ question.state
            session.change({self._task.facts[fact]: fact in question.state for fact in sorted(changed)})
            session.follow([self._task.actions[i].name for i in promise])
            result = session.plan(deadline=deadline)
        else:
            result = kept[1]
        self._keep(question.state, removed, result)
        return result

    def _keep(self, state: frozenset[int], removed: frozenset[int], result: Result) -> None:
        """What is left of a plan that is proved to be the best stays so while all goes as planned."""
        if result.status != "optimal" or result.plan is None:
            self._kept.pop(removed, None)
            return
        now, rest = [], []
        for step in result.plan:
            if step.epoch > 1:
                rest.append(PlanStep(step.epoch - 1, step.agents, step.action, step.cost))
            else:
                now.append(self._task.actions[self._ids(step, state)])
        window = result.window
        if window is not None:
            window = None if window.start == 1 else Window(window.start - 1, window.end - 1)
        self._kept[removed] = apply(state, *now), replace(result, plan=tuple(rest), window=window)

    def _ids(self, step: PlanStep, state: frozenset[int]) -> int:
        """The action of a step of the first epoch, in the variant that is applicable."""
        ids = actions_named(self._task, step.action, step.agents)
        return next(i for i in ids if self._task.actions[i].applicable(state))

    def _session(self, removed: frozenset[int]) -> Session:
        session = self._sessions.get(removed)
        if session is None:
            session = self._sessions[removed] = Session(self._without(removed), **self._options)
            if len(self._sessions) > _MOST:
                self._kept.pop(self._sessions.popitem(last=False)[0], None)
        self._sessions.move_to_end(removed)
        return session

    def _without(self, removed: frozenset[int]) -> Task:
        if not removed:
            return self._task
        kept = tuple(action for i, action in enumerate(self._task.actions) if i not in removed)
        return replace(self._task, actions=kept, known_variables=self._task.variables)
