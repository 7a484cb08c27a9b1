"""Admissible bounds on what the human still has to pay, by projection.

His *private* variables are those that no action changes without him.  Projected
onto them, with every other condition dropped, each of his actions (joint ones
included) is a weighted transition; exact distances to the projected goal bound
his share of any plan from below, in every mode, since robots' costs are only
left out.  This is a pattern database (Culberson and Schaeffer 1998) on one
agent's variables.
"""

from collections.abc import Callable
from heapq import heapify, heappop, heappush

from search.clock import Clock
from search.encoding import Encoding, Goal, Op
from search.keys import INFINITE_KEY

_MAX_STATES = 50_000
_CHECK_EVERY = 1024


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


def human_projection(
    encoding: Encoding, goal: Goal, weight: Callable[[int], int], clock: Clock
) -> Projection:
    """The projection onto the human's private variables, or onto as many as stay tractable.

    Args:
        encoding: the packed task.
        goal: what he wants.
        weight: key increment of an action.
        clock: asked for time while the table is built.
    """
    task = encoding.task
    human_bit = 1 << task.human
    ops = [encoding.op(i) for i in encoding.useful]
    own = [op for op in ops if op.agents & human_bit]
    others = [op for op in ops if not op.agents & human_bit]
    changed, shared = encoding.changed_by(own), encoding.changed_by(others)
    private = [mask for mask in encoding.fields if mask & changed and not mask & shared]
    for fields in _patterns(private, goal):
        distances = _distances(encoding.init, fields, own, goal, weight, clock)
        if distances is not None:
            return Projection(sum(fields), distances)
    return Projection(0, {0: 0})


def _patterns(private: list[int], goal: Goal) -> list[list[int]]:
    """All private fields, then fewer and fewer, those of the goal kept to the last."""
    asked = goal.need_mask
    for mask, _ in goal.forbidden:
        asked |= mask
    ranked = sorted(private, key=lambda mask: (not mask & asked, mask))
    return [ranked[:n] for n in range(len(ranked), 0, -1)]


def _distances(
    start: int, fields: list[int], ops: list[Op], goal: Goal, weight: Callable[[int], int], clock: Clock
) -> dict[int, int] | None:
    """Backward Dijkstra over the states that are reachable forward; None if they are too many."""
    mask = sum(fields)
    predecessors = _explore(start & mask, _Moves(fields, ops, weight), clock)
    if predecessors is None:
        return None
    distances: dict[int, int] = {}
    queue = [(0, state) for state in predecessors if _satisfies(state, mask, goal)]
    heapify(queue)
    while queue:
        distance, state = heappop(queue)
        if state in distances:
            continue
        distances[state] = distance
        for before, step in predecessors[state]:
            if before not in distances:
                heappush(queue, (distance + step, before))
    return distances


def _satisfies(state: int, mask: int, goal: Goal) -> bool:
    if state & goal.need_mask != goal.need & mask:
        return False
    return all(not m & mask or state & m != value for m, value in goal.forbidden)


def _explore(
    start: int, moves: "_Moves", clock: Clock
) -> dict[int, list[tuple[int, int]]] | None:
    """Predecessors, with weights, of every projected state reachable from ``start``."""
    predecessors: dict[int, list[tuple[int, int]]] = {start: []}
    pending = [start]
    count = 0
    while pending:
        state = pending.pop()
        count += 1
        if not count % _CHECK_EVERY:
            clock.check()
        for after, step in moves(state):
            known = predecessors.get(after)
            if known is None:
                if len(predecessors) >= _MAX_STATES:
                    return None
                predecessors[after] = [(state, step)]
                pending.append(after)
            else:
                known.append((state, step))
    return predecessors


Transition = tuple[int, int, int, int, tuple[tuple[int, int], ...], int]
"""``need_mask, need, keep, put, forbidden, weight`` of an op seen through the projection."""


class _Moves:
    """Successors in the projection; ops that look alike there are merged, the cheapest kept."""

    def __init__(self, fields: list[int], ops: list[Op], weight: Callable[[int], int]) -> None:
        mask = sum(fields)
        merged: dict[tuple[int, int, int, int, tuple[tuple[int, int], ...]], int] = {}
        for op in ops:
            clear = mask & ~op.keep
            if not clear:
                continue
            forbidden = tuple((m, v) for m, v in op.forbidden if m & mask)
            need = -1 if op.need < 0 else op.need & mask
            form = (op.need_mask & mask, need, clear, op.put & mask, forbidden)
            step = weight(op.action)
            merged[form] = min(step, merged.get(form, step))
        self.index = max(fields, key=lambda field: sum(bool(form[0] & field) for form in merged))
        self.by_value: dict[int, list[Transition]] = {}
        self.always: list[Transition] = []
        for (need_mask, need, clear, put, forbidden), step in merged.items():
            entry = (need_mask, need, ~clear, put, forbidden, step)
            if need_mask & self.index:
                self.by_value.setdefault(need & self.index, []).append(entry)
            else:
                self.always.append(entry)

    def __call__(self, state: int) -> list[tuple[int, int]]:
        found = []
        for entries in (self.by_value.get(state & self.index, ()), self.always):
            for need_mask, need, keep, put, forbidden, step in entries:
                if state & need_mask == need:
                    after = state & keep | put
                    if after != state and all(state & m != value for m, value in forbidden):
                        found.append((after, step))
        return found
