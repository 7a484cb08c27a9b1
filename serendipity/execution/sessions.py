"""Planning sessions that lack some actions, and stand wherever they are asked about."""

from dataclasses import replace
from typing import Any, Final

from serendipity.facade.session import Session
from serendipity.model.task.task import Task

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
