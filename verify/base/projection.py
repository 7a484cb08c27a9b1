"""A lower bound on the human's cost alone: exact distances in a projection.

The projection keeps the variables that robots alone never change (their position,
whether they hold something), as long as it stays small.  Dropping the other facts only
makes actions applicable more often, so the bound is admissible.
"""

from collections.abc import Iterable
from typing import Final

from serendipity.model import Condition, Deadline, Task
from verify.base.operators import OwnActions
from verify.base.shortest_paths import dijkstra

_MOST_STATES: Final = 20_000

Projected = frozenset[int]
_Move = tuple[Projected, Projected, Projected, Projected]
"""Precondition, forbidden facts, adds, deletes."""


class ProjectedCosts:
    """Weights of cheapest plans in the projection, for the states that are reached from those asked for.

    Args:
        task: the task.
        own: the human's own actions.
        deadline: polled, also by :meth:`bound`.
    """

    def __init__(self, task: Task, own: OwnActions, deadline: Deadline) -> None:
        self._deadline = deadline
        self.kept = _private_facts(task, own, deadline)
        self._goal = _restricted(task.goal, self.kept)
        self._by_need: dict[int | None, list[tuple[_Move, int]]] = {}
        for move, weight in _moves(task, own, self.kept, deadline).items():
            self._by_need.setdefault(min(move[0], default=None), []).append((move, weight))
        self._distance: dict[Projected, int] = {}
        self._seen: set[Projected] = set()

    def bound(self, state: frozenset[int]) -> int | None:
        """Least weight of a plan from ``state`` in the projection; None: there is no plan at all."""
        projected = state & self.kept
        if projected not in self._seen and len(self._seen) <= _MOST_STATES:
            self._explore(projected)
        if len(self._seen) > _MOST_STATES:
            return 0
        return self._distance.get(projected)

    def _explore(self, start: Projected) -> None:
        """Everything reachable from ``start``, then one Dijkstra backward over what is new."""
        new, stack = {start}, [start]
        edges: dict[Projected, list[tuple[Projected, int]]] = {}
        while stack and len(self._seen) + len(new) <= _MOST_STATES:
            self._deadline.tick()
            state = stack.pop()
            if self._goal.holds(state):
                continue  # no cheapest plan goes on from here
            for successor, weight in self._successors(state):
                edges.setdefault(successor, []).append((state, weight))
                if successor not in self._seen and successor not in new:
                    new.add(successor)
                    stack.append(successor)
        known = [(state, self._distance[state]) for state in edges if state in self._distance]
        goals = [(state, 0) for state in new if self._goal.holds(state)]
        self._distance |= dijkstra(known + goals, lambda state: edges.get(state, ()), self._deadline)
        self._seen |= new

    def _successors(self, state: Projected) -> Iterable[tuple[Projected, int]]:
        for fact in (None, *state):
            for (pre, neg, add, delete), weight in self._by_need.get(fact, ()):
                if pre <= state and neg.isdisjoint(state):
                    yield (state - delete) | add, weight


def _private_facts(task: Task, own: OwnActions, deadline: Deadline) -> frozenset[int]:
    """Relevant facts of the variables that robots alone never change, few enough to enumerate."""
    shared: set[int] = set()
    for action in deadline.each(task.actions):
        if task.human not in action.participants:
            shared.update(action.add, action.delete)
    kept: set[int] = set()
    size = 1
    for variable in sorted(task.variables, key=lambda v: -len(v.facts)):
        facts = own.facts.intersection(variable.facts)
        values = len(facts) + 1
        if facts and shared.isdisjoint(variable.facts) and size * values <= _MOST_STATES:
            kept |= facts
            size *= values
    return frozenset(kept)


def _moves(task: Task, own: OwnActions, kept: frozenset[int], deadline: Deadline) -> dict[_Move, int]:
    """The distinct projected actions that change anything, each at its least weight."""
    moves: dict[_Move, int] = {}
    for i in deadline.each(own.ids):
        action = task.actions[i]
        add, delete = kept.intersection(action.add), kept.intersection(action.delete)
        if add or delete:
            move = (kept.intersection(action.pre), kept.intersection(action.neg), add, delete)
            weight = own.weight(i)
            moves[move] = min(weight, moves.get(move, weight))
    return moves


def _restricted(goal: Condition, kept: frozenset[int]) -> Condition:
    return Condition(
        tuple(f for f in goal.positive if f in kept), tuple(f for f in goal.negative if f in kept)
    )
