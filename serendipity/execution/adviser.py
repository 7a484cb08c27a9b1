"""What robots had best do from here, without what they must leave alone: planning calls through a session."""

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

from serendipity.facade.session import Session
from serendipity.model.answers.result import Result
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
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
            "discount": options.discount,
            "human_model": options.human_model,
            "interference": options.interference,
        }
        self._sessions: OrderedDict[frozenset[int], Session] = OrderedDict()

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
        session = self._session(removed)
        changed = session.task.init ^ state
        session.change({self._task.facts[fact]: fact in state for fact in sorted(changed)})
        session.follow(expected)
        return session.plan(deadline=deadline)

    def _session(self, removed: frozenset[int]) -> Session:
        session = self._sessions.get(removed)
        if session is None:
            session = self._sessions[removed] = Session(self._without(removed), **self._options)
            if len(self._sessions) > _MOST:
                self._sessions.popitem(last=False)
        self._sessions.move_to_end(removed)
        return session

    def _without(self, removed: frozenset[int]) -> Task:
        if not removed:
            return self._task
        kept = tuple(action for i, action in enumerate(self._task.actions) if i not in removed)
        return replace(self._task, actions=kept, known_variables=self._task.variables)
