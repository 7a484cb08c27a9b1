"""The prepared tasks of the last few tasks that calls were asked about.

Callers have tasks, which are plain values, and ask about one of them again and again: with
another discount, for an explanation, in a control loop.  What the first call has found out about
it serves the next ones, so it is held here.  Calls write down what they find, the kernel in memory of
its own, so a prepared task serves one call at a time: it is taken out meanwhile, and a call in another
thread prepares the task anew.  A :class:`serendipity.Session` has taken out its own.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from search import PreparedTask
from serendipity.model import Task
from serendipity.model.arguments import TASK_IN_TIME, expect

_MOST: Final = 8
"""Tasks at once: more than a caller goes back and forth between."""

_MOST_ACTIONS: Final = 50_000
"""Ground actions of all of them together, some 50 MiB; the last task may be larger by itself."""


class LastPrepared:
    """Prepared tasks, the one put back last in front; the one put back longest ago goes first.

    Tasks are told apart by identity: to compare two large ones takes longer than to plan for one.

    Args:
        most: how many are held.
        most_actions: how many ground actions they have together, unless it is but one.
    """

    def __init__(self, most: int, most_actions: int) -> None:
        self._most = most
        self._most_actions = most_actions
        self._lock = threading.RLock()  # a collection may end a call that nobody listens to any more
        self._held: tuple[PreparedTask, ...] = ()

    @contextmanager
    def taken(self, task: Task) -> Iterator[PreparedTask]:
        """The prepared task of a task, for one call; it is put back at the end.

        Raises:
            UsageError: it is no task.
        """
        prepared = self.take(task)
        try:
            yield prepared
        finally:
            self.hold(prepared)

    def take(self, task: Task) -> PreparedTask:
        """The prepared task of a task: the one that is held, and no longer is, or else a new one.

        Raises:
            UsageError: it is no task.
        """
        expect(TASK_IN_TIME, task=task)
        with self._lock:
            known = next((prepared for prepared in self._held if prepared.task is task), None)
            self._held = tuple(prepared for prepared in self._held if prepared is not known)
        return known or PreparedTask(task)

    def hold(self, prepared: PreparedTask) -> None:
        """Hold one that nobody uses, instead of another one of its task."""
        with self._lock:
            kept, room = [prepared], self._most_actions - len(prepared.task.actions)
            for held in self._held:
                if held.task is not prepared.task:
                    room -= len(held.task.actions)
                    if room < 0 or len(kept) == self._most:
                        break
                    kept.append(held)
            self._held = tuple(kept)


HELD: Final = LastPrepared(_MOST, _MOST_ACTIONS)
"""Shared by all calls of a process; :mod:`.loading` feeds it, too."""
