"""Exact distances to a goal for every state of a transition system that is reachable from a query.

A query explores what is reachable from its state, then runs Dijkstra backward over it; so
a state costs work once.  Where that is much, only what is near the goal is looked at.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from search.engine.shortest_paths import backward
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operator_index import OperatorIndex, most_asked
from search.packed.packed_task import PackedGoal
from serendipity.model.resources.deadline import Deadline

if TYPE_CHECKING:
    from search.modes.assistance.distances.perimeter import Perimeter

SMALL: Final = 5_000
"""States that are all looked at before only those near the goal are."""


class ClosureTooLargeError(Exception):
    """The closure of a state is larger than the limit."""


class Arc(NamedTuple):
    """A weighted transition: where it applies, what it keeps and puts, its weight."""

    condition: PackedGoal
    keep: int
    put: int
    weight: int


class Closure:
    """Distances, filled in where they are asked for.

    Args:
        goal: where the distance is 0 (and nothing goes on).
        fields: all values of each field that a state consists of, by its mask.
        limit: most states of one closure.
    """

    def __init__(
        self,
        arcs: list[Arc],
        goal: PackedGoal,
        fields: Mapping[int, Sequence[int]],
        limit: int,
        deadline: Deadline,
    ) -> None:
        self._arcs = [arc for arc in arcs if arc.condition.need >= 0]
        self._goal = goal
        self._fields = fields
        self._limit = limit
        self._deadline = deadline
        self._known: dict[int, int] = {}
        self._index: OperatorIndex[Arc] = OperatorIndex(
            most_asked([*fields], ((arc.condition.need_mask, 1) for arc in self._arcs))
        )
        for arc in self._arcs:
            self._index.add(arc.condition.need_mask, arc.condition.need, arc)
        self._ball: Perimeter | None = None

    def key(self, state: int, limit: int = INFINITE_KEY) -> int:
        """Distance from ``state`` (only the masked fields set), or ``INFINITE_KEY``.

        Args:
            limit: in the unit of the arcs' weights; at or above it any value that is not above the distance.

        Raises:
            ClosureTooLargeError: its closure exceeds the limit.
        """
        known = self._known.get(state)
        if known is not None:
            return known
        if self._ball is not None:
            distance = self._ball.key(state, limit)
            if distance is not None:
                if distance < limit or distance >= INFINITE_KEY:
                    self._known[state] = distance
                return distance
        few = min(SMALL, self._limit)
        settled = self._settle(state, few)
        if few < self._limit:
            settled = settled or self._grow_ball(state) or self._settle(state, self._limit)
        if not settled:
            raise ClosureTooLargeError
        return self.key(state, limit)

    def _settle(self, start: int, most: int) -> bool:
        """Distances of all that is reachable, unless that is more than so many states."""
        predecessors: dict[int, list[tuple[int, int]]] = {start: []}
        pending = [start]
        seeds: list[tuple[int, int]] = []
        known, holds = self._known, self._goal.holds
        while pending:
            state = pending.pop()
            self._deadline.tick()
            if state in known:
                seeds.append((known[state], state))
            elif holds(state):
                seeds.append((0, state))
            else:
                for after, weight in self._successors(state):
                    before = predecessors.get(after)
                    if before is None:
                        before = predecessors[after] = []
                        pending.append(after)
                    before.append((weight, state))
            if len(predecessors) > most:
                return False
        ends = (seed for seed in seeds if seed[0] < INFINITE_KEY)
        distances = backward(ends, [predecessors], self._deadline)
        for state in predecessors:
            known[state] = distances.get(state, INFINITE_KEY)
        return True

    def _successors(self, state: int) -> list[tuple[int, int]]:
        """Where arcs lead from a state, and their weights; those that lead nowhere else are left out."""
        found = []
        for condition, keep, put, weight in self._index.candidates(state):
            if state & condition.need_mask == condition.need and (
                not condition.forbidden or condition.holds(state)
            ):
                after = state & keep | put
                if after != state:
                    found.append((after, weight))
        return found

    def _grow_ball(self, start: int) -> bool:
        """Whether there is a ball now that there was not before."""
        # Loads numpy: only a task with a large closure pays for it.
        from search.modes.assistance.distances.perimeter import ball_around

        if self._ball is not None:
            return False
        self._ball = ball_around(self._arcs, self._goal, self._fields, start, self._deadline)
        return self._ball is not None
