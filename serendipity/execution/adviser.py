"""What robots had best do from here, without what they must leave alone: planning calls through a session."""

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

from serendipity.facade.session import Session
from serendipity.model.answers.result import Result
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import actions_named
from serendipity.model.task.plans import PlanStep, Window
from serendipity.model.task.task import Task

_MOST: Final = 3
"""Sessions at once: what is to be left alone changes seldom, and goes back and forth."""


class Adviser:
    """Plans for one goal of the person's.

    Args:
        task: the task with that goal.
        options: of the planning calls.
    """

    def __init__(self, task: Task, options: Options) -> None:
        self._task = task
        self._options: dict[str, Any] = {
            "mode": options.mode,
            "discount": options.discount,
            "human_model": options.human_model,
            "interference": options.interference,
        }
        self._sessions: OrderedDict[frozenset[int], Session] = OrderedDict()
        self._kept: dict[frozenset[int], tuple[frozenset[int], Result]] = {}

    def advise(
        self,
        state: frozenset[int],
        expected: Sequence[str],
        removed: frozenset[int],
        deadline: Deadline,
    ) -> Result:
        """The best plan from a state.

        Args:
            state: ids of the facts that are true.
            expected: names of what the person is going to do.
            removed: ids of actions that nobody may do.
            deadline: of the call; the best answer by then counts.
        """
        kept = self._kept.get(removed)
        if kept is None or kept[0] != state:
            session = self._session(removed)
            changed = session.task.init ^ state
            session.change({self._task.facts[fact]: fact in state for fact in sorted(changed)})
            session.follow(expected)
            result = session.plan(deadline=deadline)
        else:
            result = kept[1]
        self._keep(state, removed, result)
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
                ids = actions_named(self._task, step.action, step.agents)
                actions = [self._task.actions[i] for i in ids]
                now.append(next(action for action in actions if action.applicable(state)))
        window = result.window
        if window is not None:
            window = None if window.start == 1 else Window(window.start - 1, window.end - 1)
        self._kept[removed] = apply(state, *now), replace(result, plan=tuple(rest), window=window)

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
