"""A lower bound on the human's cost alone: exact distances in a projection.

The projection keeps the variables that robots alone never change (their position,
whether they hold something), as long as it stays small.  Dropping the other facts only
makes actions applicable more often, so the bound is admissible.
"""

from collections.abc import Iterable
from itertools import chain

from serendipity.model import Deadline, Task
from verify.base.fact_bits import each_bit
from verify.base.operators import OwnActions
from verify.base.shortest_paths import dijkstra
from verify.limits import limits

_Move = tuple[int, int, int, int]
"""Precondition, forbidden facts, adds, deletes, as bits (:class:`.FactBits`) of the human's own facts."""


class ProjectedCosts:
    """Weights of cheapest plans in the projection, for the states that are reached from those asked for.

    Args:
        task: the task.
        own: the human's own actions.
        deadline: polled, also by :meth:`bound`.
    """

    def __init__(self, task: Task, own: OwnActions, deadline: Deadline) -> None:
        self._deadline, self._most = deadline, limits().projected_states
        self._kept = own.bits.of(_private_facts(task, own, deadline))
        self._wanted = own.bits.of(task.goal.positive) & self._kept
        self._unwanted = own.bits.of(task.goal.negative) & self._kept
        self._by_need: dict[int, list[tuple[_Move, int]]] = {}
        for move, weight in _moves(task, own, self._kept, deadline).items():
            self._by_need.setdefault(move[0] & -move[0], []).append((move, weight))
        self._distance: dict[int, int] = {}
        self._seen: set[int] = set()

    def bound(self, state: int) -> int | None:
        """Least weight of a plan from ``state`` in the projection; None: there is no plan at all."""
        projected = state & self._kept
        if projected not in self._seen and len(self._seen) <= self._most:
            self._explore(projected)
        if len(self._seen) > self._most:
            return 0
        return self._distance.get(projected)

    def _explore(self, start: int) -> None:
        """Everything reachable from ``start``, then one Dijkstra backward over what is new."""
        new, stack = {start}, [start]
        edges: dict[int, list[tuple[int, int]]] = {}
        while stack and len(self._seen) + len(new) <= self._most:
            self._deadline.tick()
            state = stack.pop()
            if self._is_goal(state):
                continue  # no cheapest plan goes on from here
            for successor, weight in self._successors(state):
                edges.setdefault(successor, []).append((state, weight))
                if successor not in self._seen and successor not in new:
                    new.add(successor)
                    stack.append(successor)
        known = [(state, self._distance[state]) for state in edges if state in self._distance]
        goals = [(state, 0) for state in new if self._is_goal(state)]
        self._distance |= dijkstra(known + goals, lambda state: edges.get(state, ()), self._deadline)
        self._seen |= new

    def _is_goal(self, state: int) -> bool:
        return state & self._wanted == self._wanted and not state & self._unwanted

    def _successors(self, state: int) -> Iterable[tuple[int, int]]:
        for bit in chain((0,), each_bit(state)):
            for (pre, neg, add, delete), weight in self._by_need.get(bit, ()):
                if state & pre == pre and not state & neg:
                    yield state & ~delete | add, weight


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
        if facts and shared.isdisjoint(variable.facts) and size * values <= limits().projected_states:
            kept |= facts
            size *= values
    return frozenset(kept)


def _moves(task: Task, own: OwnActions, kept: int, deadline: Deadline) -> dict[_Move, int]:
    """The distinct projected actions that change anything, each at its least weight."""
    moves: dict[_Move, int] = {}
    of = own.bits.of
    for i in deadline.each(own.ids):
        action = task.actions[i]
        add, delete = of(action.add) & kept, of(action.delete) & kept
        if add or delete:
            move = of(action.pre) & kept, of(action.neg) & kept, add, delete
            weight = own.weight(i)
            moves[move] = min(weight, moves.get(move, weight))
    return moves
