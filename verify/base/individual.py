"""The human alone: (cost, length) of an optimal plan of his from a state, by A*."""

import heapq
from fractions import Fraction
from functools import cached_property
from itertools import count
from typing import Final

from serendipity.model import Deadline, Task
from verify.base.operators import OwnActions
from verify.base.projection import ProjectedCosts
from verify.base.undecided import TooManyStatesError, during

_MOST_EXPANSIONS: Final = 200_000


class IndividualOptimum:
    """Optimal (cost, length) of the human alone; tables are built when first needed.

    Args:
        task: the task.
        deadline: polled by every question; None for no limit.
    """

    def __init__(self, task: Task, deadline: Deadline | None = None) -> None:
        self._task = task
        self.deadline = deadline or Deadline()
        self._known: dict[frozenset[int], tuple[Fraction, int] | None] = {}

    @cached_property
    def _own(self) -> OwnActions:
        return OwnActions(self._task, self.deadline)

    @cached_property
    def _projection(self) -> ProjectedCosts:
        return ProjectedCosts(self._task, self._own, self.deadline)

    def optimum(self, state: frozenset[int]) -> tuple[Fraction, int] | None:
        """Least (cost, number of actions) from ``state``; None if he can't reach ``G_H`` alone.

        Raises:
            TooManyStatesError: the limit on expansions came first.
            LimitReachedError: the deadline did.
        """
        if self._task.goal.holds(state):
            return Fraction(0), 0
        start = state & self._own.facts
        if start not in self._known:
            with during("searching for what the human can do alone"):
                weight = self._search(start)
            self._known[start] = None if weight is None else self._own.split(weight)
        return self._known[start]

    def _search(self, start: frozenset[int]) -> int | None:
        bound, goal = self._projection.bound, self._task.goal
        estimate = bound(start)
        if estimate is None:
            return None
        ticket = count()
        best = {start: 0}
        queue = [(estimate, 0, next(ticket), start)]
        expansions = 0
        while queue:
            _, negative, _, state = heapq.heappop(queue)
            if -negative > best[state]:
                continue
            if goal.holds(state):
                return -negative
            self.deadline.check()
            expansions += 1
            if expansions > _MOST_EXPANSIONS:
                raise TooManyStatesError
            for operator in self._own.applicable(state):
                successor = (state - operator.delete) | operator.add
                weight = operator.weight - negative
                if weight < best.get(successor, weight + 1):
                    left = bound(successor)
                    if left is not None:
                        best[successor] = weight
                        heapq.heappush(queue, (weight + left, -weight, next(ticket), successor))
        return None
