"""The prepared tasks of the last few tasks that calls were asked about.

Callers have tasks, which are plain values, and ask about one of them again and again: with
another discount, for an explanation, in a control loop.  What the first call has found out about
it serves the next ones, so it is held here.  A :class:`serendipity.Session` holds its own.
"""

import threading
from typing import Final

from search import PreparedTask
from serendipity.model.arguments import TASK, expect
from serendipity.model.task.task import Task

_MOST: Final = 8
"""Tasks at once: more than a caller goes back and forth between."""

_MOST_ACTIONS: Final = 50_000
"""Ground actions of all of them together, some 50 MiB; the last task may be larger by itself."""


class LastPrepared:
    """Prepared tasks, the one asked for last in front; the one asked for longest ago goes first.

    Tasks are told apart by identity: to compare two large ones takes longer than to plan for one.

    Args:
        most: how many are held.
        most_actions: how many ground actions they have together, unless it is but one.
    """

    def __init__(self, most: int, most_actions: int) -> None:
        self._most = most
        self._most_actions = most_actions
        self._lock = threading.Lock()
        self._held: tuple[PreparedTask, ...] = ()

    def of(self, task: Task) -> PreparedTask:
        """The prepared task of a task: the one that is held, or else one that is held from now on.

        Raises:
            UsageError: it is no task.
        """
        held = self._held
        if held and held[0].task is task:
            return held[0]
        expect(TASK, task=task)
        with self._lock:
            known = next((prepared for prepared in self._held if prepared.task is task), None)
            return self._hold(known or PreparedTask(task))

    def hold(self, prepared: PreparedTask) -> None:
        """Hold one that was prepared elsewhere."""
        with self._lock:
            self._hold(prepared)

    def _hold(self, prepared: PreparedTask) -> PreparedTask:
        kept, room = [prepared], self._most_actions - len(prepared.task.actions)
        for held in self._held:
            if held.task is not prepared.task:
                room -= len(held.task.actions)
                if room < 0 or len(kept) == self._most:
                    break
                kept.append(held)
        self._held = tuple(kept)
        return prepared


HELD: Final = LastPrepared(_MOST, _MOST_ACTIONS)
"""Shared by all calls of a process; :mod:`.loading` feeds it, too."""
