"""Admissible bounds on what the human still has to pay, by projection.

His *private* variables are those that no action changes without him.  Projected
onto them, with every other condition dropped, each of his actions (joint ones
included) is a weighted transition; exact distances to the projected goal bound
his share of any plan from below, in every mode, since robots' costs are only
left out.  This is a pattern database (Culberson and Schaeffer 1998) on one
agent's variables.  It depends on the task alone and is kept with it; a call has
the distances in its keys.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from search.clock import Clock
from search.encoding import Encoding, Goal, Op
from search.keys import INFINITE_KEY, Weights, own_actions, own_weights

_MAX_STATES = 50_000

Predecessors = dict[int, list[tuple[int, int]]]
"""Per projected state the states before it, each with the index of the cheapest cost."""


class Projection:
    """Distances to the goal in a projection.

    Attributes:
        mask: the fields that the projection keeps.
        distances: key increment to the goal per projected state; a state that is not
            listed can't reach the goal.
    """

    __slots__ = ("distances", "mask")

    def __init__(self, mask: int, distances: dict[int, int]) -> None:
        self.mask = mask
        self.distances = distances

    def __call__(self, state: int) -> int:
        """Lower bound of the key increment from a packed state; ``INFINITE_KEY`` if none."""
        return self.distances.get(state & self.mask, INFINITE_KEY)


@dataclass(frozen=True, slots=True)
class Projected:
    """The human's actions projected onto fields of his, as far as they lead from ``I``.

    Attributes:
        mask: the fields that are kept.
        predecessors: per projected state what leads to it.
    """

    mask: int
    predecessors: Predecessors


def human_projection(encoding: Encoding, weights: Weights, clock: Clock) -> Projection:
    """Key increments to his goal in his private variables, or in as many as stay tractable.

    Args:
        encoding: the packed task.
        weights: key increments of the call.
        clock: asked for time while the table is built.
    """
    own = encoding.derived(own_projection, clock)
    return Projection(own.mask, weights.of_own(own.distances))


def own_projection(encoding: Encoding, clock: Clock) -> Projection:
    """The same in the unit of :func:`search.keys.own_weights`."""
    graph = encoding.derived(human_graph, clock)
    return Projection(graph.mask, _distances(graph, encoding.goal, own_weights(encoding), clock))


def human_steps(encoding: Encoding, clock: Clock) -> Projection:
    """The least number of his actions to his goal, in the same variables."""
    if len(encoding.costs) == 1:  # every action costs the same, so the cheapest way is the shortest
        own = encoding.derived(own_projection, clock)
        return Projection(own.mask, {at: own_actions(cost) for at, cost in own.distances.items()})
    graph = encoding.derived(human_graph, clock)
    return Projection(graph.mask, _distances(graph, encoding.goal, [1] * len(encoding.costs), clock))


def human_graph(encoding: Encoding, clock: Clock) -> Projected:
    """His graph over all his private fields, or over as many as stay tractable."""
    own = (*encoding.own, *encoding.joint)
    changed, shared = encoding.changed_by(own), encoding.outside
    private = [field for field in encoding.fields if field & changed and not field & shared]
    goal_first = sorted(private, key=lambda field: (not field & encoding.goal.mask, field))
    for count in range(len(private), 0, -1):
        fields = goal_first[:count]
        mask = sum(fields)
        predecessors = _explore(encoding.init & mask, _Moves(fields, own, clock), clock)
        if predecessors is not None:
            return Projected(mask, predecessors)
    return Projected(0, {0: []})


def _distances(graph: Projected, goal: Goal, weights: Sequence[int], clock: Clock) -> dict[int, int]:
    """Backward Dijkstra over the projected states that are reachable forward."""
    distances: dict[int, int] = {}
    queue = [(0, state) for state in graph.predecessors if _satisfies(state, graph.mask, goal)]
    heapify(queue)
    while queue:
        distance, state = heappop(queue)
        if state in distances:
            continue
        distances[state] = distance
        clock.tick()
        for before, cost in graph.predecessors[state]:
            if before not in distances:
                heappush(queue, (distance + weights[cost], before))
    return distances


def _satisfies(state: int, mask: int, goal: Goal) -> bool:
    if goal.need < 0 or state & goal.need_mask != goal.need & mask:
        return False
    return all(not m & mask or state & m != value for m, value in goal.forbidden)


def _explore(start: int, moves: "_Moves", clock: Clock) -> Predecessors | None:
    """Predecessors of every projected state reachable from ``start``; None if too many."""
    predecessors: Predecessors = {start: []}
    pending = [start]
    while pending:
        state = pending.pop()
        clock.tick()
        for after, cost in moves(state):
            known = predecessors.get(after)
            if known is not None:
                known.append((state, cost))
            elif len(predecessors) >= _MAX_STATES:
                return None
            else:
                predecessors[after] = [(state, cost)]
                pending.append(after)
    return predecessors


Transition = tuple[int, int, int, int, tuple[tuple[int, int], ...], int]
"""``need_mask, need, keep, put, forbidden, cost`` of an op seen through the projection."""


class _Moves:
    """Successors in the projection; ops that look alike there are merged, the cheapest kept."""

    def __init__(self, fields: Sequence[int], ops: Sequence[Op], clock: Clock) -> None:
        mask = sum(fields)
        merged: dict[tuple[int, int, int, int, tuple[tuple[int, int], ...]], int] = {}
        for op in ops:
            clock.tick()
            if op.keep & mask == mask or op.need < 0:
                continue
            forbidden = tuple((m, v) for m, v in op.forbidden if m & mask) if op.forbidden else ()
            form = (op.need_mask & mask, op.need & mask, op.keep & mask, op.put & mask, forbidden)
            merged[form] = min(op.cost, merged.get(form, op.cost))
        self.index = max(fields, key=lambda field: sum(form[0] & field != 0 for form in merged))
        self.by_value: dict[int, list[Transition]] = {}
        self.always: list[Transition] = []
        for (need_mask, need, keep, put, forbidden), cost in merged.items():
            entry = (need_mask, need, keep, put, forbidden, cost)
            if need_mask & self.index:
                self.by_value.setdefault(need & self.index, []).append(entry)
            else:
                self.always.append(entry)

    def __call__(self, state: int) -> list[tuple[int, int]]:
        found = []
        for entries in (self.by_value.get(state & self.index, ()), self.always):
            for need_mask, need, keep, put, forbidden, cost in entries:
                if state & need_mask == need:
                    after = state & keep | put
                    if after == state:
                        continue
                    if not forbidden or all(state & m != value for m, value in forbidden):
                        found.append((after, cost))
        return found
