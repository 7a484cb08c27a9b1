"""Bounds where the prime's optimal costs are out of reach: without deletes, and by greed.

Below: the joint optimum without deletes, by the dearest fact of the goal (h_max, Bonet
and Geffner 2001).  Above: any plan of the prime's own bounds his optimal cost, and so the
value of doing nothing; one is sought greedily by the sum of facts' costs (h_add).
"""

from collections.abc import Callable, Iterable
from heapq import heappop, heappush
from typing import NamedTuple

from search.assistance.game.game import INFINITE, Game
from serendipity.model.deadline import Deadline
from serendipity.model.task import Task


class _Action(NamedTuple):
    pre: tuple[int, ...]
    add: tuple[int, ...]
    value: int


def joint_lower_bound(game: Game, deadline: Deadline) -> int:
    """A value that no policy undercuts from the initial state.

    Raises:
        LimitReachedError: the deadline ran out before it was worked out.
    """
    task = game.task
    actions = [
        *_actions(game, deadline, prime=True, shift=game.unit_bits),
        *_actions(game, deadline, prime=False, shift=0),
    ]
    costs = _Relaxation(task, actions, max, deadline).costs(task.init)
    return max((costs.get(fact, INFINITE) for fact in task.goal.positive), default=0)


def upper_bound_alone(game: Game) -> int:
    """The value of some plan of the prime's own; ``INFINITE`` if he has none.

    Raises:
        LimitReachedError: none was found in time.
    """
    task, goal = game.task, game.task.goal
    deadline = game.deadline
    relaxation = _Relaxation(task, _actions(game, deadline, prime=True, shift=game.unit_bits), _sum, deadline)
    start = frozenset(task.init)
    queue = [(0, 0, 0, start)]
    seen = {start}
    count = 0
    while queue:
        _, _, cost, state = heappop(queue)
        if goal.holds(state):
            return cost
        for i in task.human_actions:
            deadline.tick()
            action = task.actions[i]
            if not action.applicable(state):
                continue
            after = state.difference(action.delete).union(action.add)
            if after in seen:
                continue
            seen.add(after)
            facts = relaxation.costs(after)
            estimate = sum(facts.get(fact, INFINITE) for fact in goal.positive)
            if estimate < INFINITE:
                count += 1
                value = cost + (int(action.cost * game.scale) << game.unit_bits)
                heappush(queue, (estimate, count, value, after))
    return INFINITE


def _actions(game: Game, deadline: Deadline, *, prime: bool, shift: int) -> list[_Action]:
    task = game.task
    agent = task.human if prime else task.robots[0]
    found = []
    for action in task.actions:
        deadline.tick()
        if action.participants == (agent,):
            found.append(_Action(action.pre, action.add, int(action.cost * game.scale) << shift))
    return found


def _sum(values: Iterable[int]) -> int:
    return sum(values)


class _Relaxation:
    """Costs of facts when nothing is ever unset; an action needs the ``combine`` of its facts' costs."""

    def __init__(
        self,
        task: Task,
        actions: list[_Action],
        combine: Callable[[Iterable[int]], int],
        deadline: Deadline,
    ) -> None:
        self._actions = actions
        self._combine = combine
        self._deadline = deadline
        self._needing: list[list[int]] = [[] for _ in task.facts]
        for k, action in enumerate(actions):
            deadline.tick()
            for fact in action.pre:
                self._needing[fact].append(k)

    def costs(self, state: Iterable[int]) -> dict[int, int]:
        """The cost of each fact that can be reached from a state."""
        settled: dict[int, int] = {}
        missing = [len(action.pre) for action in self._actions]
        queue = [(0, fact) for fact in state]
        for k, action in enumerate(self._actions):
            if not action.pre:
                self._apply(k, 0, queue)
        while queue:
            self._deadline.tick()
            cost, fact = heappop(queue)
            if fact in settled:
                continue
            settled[fact] = cost
            for k in self._needing[fact]:
                missing[k] -= 1
                if not missing[k]:
                    self._apply(k, self._combine(settled[f] for f in self._actions[k].pre), queue)
        return settled

    def _apply(self, k: int, needed: int, queue: list[tuple[int, int]]) -> None:
        value = needed + self._actions[k].value
        for fact in self._actions[k].add:
            heappush(queue, (value, fact))
