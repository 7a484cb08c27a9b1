"""Bounds where the prime's optimal costs are out of reach: without deletes, and by greed.

Below: the joint optimum without deletes, by the dearest fact of the goal (h_max, Bonet
and Geffner 2001).  Above: any plan of the prime's own bounds their optimal cost, and so the
value of doing nothing; one is sought greedily by the sum of facts' costs (h_add).
"""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from heapq import heappop, heappush
from typing import NamedTuple

from search.engine.and_or import AndOrGraph, Rule
from search.modes.assistance.game.game import Game
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import apply


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
    costs = _Relaxation(actions, partial(max, default=0), deadline).costs(task.init)
    return max((costs.get(fact, INFINITE_KEY) for fact in task.goal.positive), default=0)


def upper_bound_alone(game: Game) -> int:
    """The value of some plan of the prime's own; ``INFINITE_KEY`` if they have none.

    Raises:
        LimitReachedError: none was found in time.
    """
    task, goal = game.task, game.task.goal
    deadline = game.deadline
    relaxation = _Relaxation(_actions(game, deadline, prime=True, shift=game.unit_bits), sum, deadline)
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
            after = apply(state, action)
            if after in seen:
                continue
            seen.add(after)
            facts = relaxation.costs(after)
            estimate = sum(facts.get(fact, INFINITE_KEY) for fact in goal.positive)
            if estimate < INFINITE_KEY:
                count += 1
                value = cost + (int(action.cost * game.scale) << game.unit_bits)
                heappush(queue, (estimate, count, value, after))
    return INFINITE_KEY


def _actions(game: Game, deadline: Deadline, *, prime: bool, shift: int) -> list[_Action]:
    task = game.task
    agent = task.human if prime else task.robots[0]
    found = []
    for action in task.actions:
        deadline.tick()
        if action.participants == (agent,):
            found.append(_Action(action.pre, action.add, int(action.cost * game.scale) << shift))
    return found


class _Relaxation:
    """Costs of facts when nothing is ever unset; an action needs the ``combine`` of its facts' costs."""

    def __init__(
        self, actions: list[_Action], combine: Callable[[Iterable[int]], int], deadline: Deadline
    ) -> None:
        self._actions = actions
        self._combine = combine
        self._graph = AndOrGraph([Rule(action.pre, action.add) for action in actions], deadline)

    def costs(self, state: Iterable[int]) -> dict[int, int]:
        """The cost of each fact that can be reached from a state."""
        costs, _ = self._graph.settle(state, self._cost, INFINITE_KEY)
        return costs

    def _cost(self, k: int, costs: Mapping[int, int]) -> int:
        action = self._actions[k]
        return self._combine([costs[fact] for fact in action.pre]) + action.value
