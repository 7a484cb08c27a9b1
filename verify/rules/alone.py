"""The human alone: (cost, length) of an optimal plan of his from a state, by A*."""

import heapq
from fractions import Fraction
from itertools import count

from serendipity.model import Task
from verify.rules.operators import Operator, own_operators
from verify.rules.projection import Projection

_MOST_EXPANSIONS = 200_000


class TooManyStatesError(Exception):
    """The human's own problem is too large to be checked here."""


class Alone:
    """Optimal (cost, length) of the human alone, from any state; built for one task."""

    def __init__(self, task: Task) -> None:
        self._goal = task.goal
        operators, self._facts, self._weights = own_operators(task)
        self._projection = Projection(task, task.goal, operators)
        self._watched = _watched(operators)
        self._known: dict[frozenset[int], tuple[Fraction, int] | None] = {}

    def optimum(self, state: frozenset[int]) -> tuple[Fraction, int] | None:
        """Least (cost, number of actions) from ``state``; None if he can't reach ``G_H`` alone.

        Raises:
            TooManyStatesError: the limit on expansions came first.
        """
        start = state & self._facts
        if start not in self._known:
            weight = self._search(start)
            self._known[start] = None if weight is None else self._weights.split(weight)
        return self._known[start]

    def _search(self, start: frozenset[int]) -> int | None:
        bound = self._projection.bound
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
            if self._goal.holds(state):
                return -negative
            expansions += 1
            if expansions > _MOST_EXPANSIONS:
                raise TooManyStatesError
            for operator in self._applicable(state):
                successor = state.difference(operator.delete) | operator.add
                weight = operator.weight - negative
                if weight < best.get(successor, weight + 1):
                    left = bound(successor)
                    if left is not None:
                        best[successor] = weight
                        heapq.heappush(queue, (weight + left, -weight, next(ticket), successor))
        return None

    def _applicable(self, state: frozenset[int]) -> list[Operator]:
        found = []
        for fact in (None, *state):
            for operator in self._watched.get(fact, ()):
                if operator.pre <= state and operator.neg.isdisjoint(state):
                    found.append(operator)
        return found


def _watched(operators: tuple[Operator, ...]) -> dict[int | None, list[Operator]]:
    """Each operator under the precondition that the fewest operators share."""
    shared: dict[int, int] = {}
    for operator in operators:
        for fact in operator.pre:
            shared[fact] = shared.get(fact, 0) + 1
    watched: dict[int | None, list[Operator]] = {}
    for operator in operators:
        rarest = min(operator.pre, key=lambda f: (shared[f], f), default=None)
        watched.setdefault(rarest, []).append(operator)
    return watched
