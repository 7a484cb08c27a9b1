"""A lower bound on the human's cost alone: exact distances in a projection.

The projection keeps the variables that only the human's own and joint actions
change (his position, what he holds), as long as it stays small.  Dropping the other
facts only makes actions applicable more often, so the bound is admissible.
"""

import heapq
from collections.abc import Iterable

from serendipity.model import Condition, Task
from verify.rules.operators import Operator

_MOST_STATES = 20_000

Projected = frozenset[int]


class Projection:
    """Distances to the goal in the projection, by one backward Dijkstra over reachable states.

    Args:
        task: the task; only its variables are looked at.
        goal: the human's goal.
        operators: his own actions, relevant facts only.
    """

    def __init__(self, task: Task, goal: Condition, operators: Iterable[Operator]) -> None:
        operators = tuple(operators)
        self.kept = _private_facts(task, goal, operators)
        self._goal = _restricted(goal, self.kept)
        self._moves = {
            _projected(operator, self.kept): operator.weight
            for operator in sorted(operators, key=lambda o: -o.weight)
        }
        self._by_need: dict[int | None, list[tuple[Operator, int]]] = {}
        for move, weight in self._moves.items():
            if move.add or move.delete:
                self._by_need.setdefault(min(move.pre, default=None), []).append((move, weight))
        self._distance: dict[Projected, int] = {}
        self._seen: set[Projected] = set()

    def bound(self, state: frozenset[int]) -> int | None:
        """Least weight of a plan from ``state`` in the projection; None: there is no plan at all."""
        if len(self._seen) > _MOST_STATES:
            return 0
        projected = state & self.kept
        if projected not in self._seen:
            self._explore(projected)
            if len(self._seen) > _MOST_STATES:
                return 0
        return self._distance.get(projected)

    def _explore(self, start: Projected) -> None:
        stack = [start]
        edges: dict[Projected, list[tuple[Projected, int]]] = {}
        self._seen.add(start)
        new = {start}
        queue: list[tuple[int, int, Projected]] = []
        while stack and len(self._seen) <= _MOST_STATES:
            state = stack.pop()
            if self._goal.holds(state):
                queue.append((0, len(queue), state))
            for successor, weight in self._successors(state):
                edges.setdefault(successor, []).append((state, weight))
                if successor not in self._seen:
                    self._seen.add(successor)
                    new.add(successor)
                    stack.append(successor)
        queue += [
            (self._distance[state], len(queue) + n, state)
            for n, state in enumerate(edges)
            if state in self._distance
        ]
        self._settle(queue, edges, new)

    def _settle(
        self,
        queue: list[tuple[int, int, Projected]],
        edges: dict[Projected, list[tuple[Projected, int]]],
        new: set[Projected],
    ) -> None:
        heapq.heapify(queue)
        ticket = 2 * len(queue)
        settled: set[Projected] = set()
        while queue:
            distance, _, state = heapq.heappop(queue)
            if state in settled:
                continue
            settled.add(state)
            if state in new:
                self._distance[state] = distance
            for before, weight in edges.get(state, ()):
                if before not in settled:
                    ticket += 1
                    heapq.heappush(queue, (distance + weight, ticket, before))

    def _successors(self, state: Projected) -> Iterable[tuple[Projected, int]]:
        for fact in (None, *state):
            for move, weight in self._by_need.get(fact, ()):
                if move.pre <= state and move.neg.isdisjoint(state):
                    yield state.difference(move.delete) | move.add, weight


def _private_facts(task: Task, goal: Condition, operators: tuple[Operator, ...]) -> frozenset[int]:
    """Facts of the variables that robots alone never change, few enough to enumerate."""
    relevant = {*goal.positive, *goal.negative}
    for operator in operators:
        relevant |= operator.pre | operator.neg
    shared = {
        fact
        for action in task.actions
        if task.human not in action.participants
        for fact in (*action.add, *action.delete)
    }
    kept: set[int] = set()
    size = 1
    for variable in sorted(task.variables, key=lambda v: -len(v.facts)):
        facts = relevant.intersection(variable.facts)
        values = len(facts) + 1
        if facts and shared.isdisjoint(variable.facts) and size * values <= _MOST_STATES:
            kept |= facts
            size *= values
    return frozenset(kept)


def _projected(operator: Operator, kept: frozenset[int]) -> Operator:
    return Operator(operator.pre & kept, operator.neg & kept, operator.add & kept, operator.delete & kept, 0)


def _restricted(goal: Condition, kept: frozenset[int]) -> Condition:
    return Condition(
        tuple(f for f in goal.positive if f in kept), tuple(f for f in goal.negative if f in kept)
    )
