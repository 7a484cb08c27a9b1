"""The human's side of help: his way to each touch, and on to the goal, in his private fields."""

from collections.abc import Sequence
from heapq import heapify, heappop, heappush

from search.keys import INFINITE_KEY
from search.projection import Projection
from search.touches import Touches

NEVER = 1 << 40
"""An epoch after every horizon."""


class Ways:
    """Distances by moves alone, up to a first touch.

    Args:
        touches: what his ops mention.
        bound: private distances to the goal.
        steps: the same, counting actions.
        weights: key increment of an op of his by the index of its cost.

    Attributes:
        steps_after: least number of actions to the goal after a touch, by its need, over
            the touches that :meth:`totals` has met.
    """

    def __init__(
        self, touches: Touches, bound: Projection, steps: Projection, weights: Sequence[int]
    ) -> None:
        self._touches = touches
        self._bound = bound
        self._steps = steps
        self._weights = weights
        self._before: dict[int, list[tuple[int, int]]] = {}
        self._entries: dict[int, list[tuple[int, int]]] = {}
        self.steps_after: dict[int, int] = {}

    def totals(self, state: int, base: int, limit: int) -> tuple[int, dict[int, int]]:
        """From a packed state: least total without a touch, and by the first touch's need.

        Args:
            state: where he starts.
            base: what has been spent.
            limit: totals at or above it are left out.
        """
        start = state & self._touches.mask
        bound, weights = self._bound.distances, self._weights
        queue = [(base, start)]
        seen: set[int] = set()
        without = INFINITE_KEY
        totals: dict[int, int] = {}
        while queue:
            spent, at = heappop(queue)
            if at in seen:
                continue
            seen.add(at)
            rest = bound.get(at, INFINITE_KEY)
            if spent + rest >= limit:
                continue
            if rest == 0:
                without = min(without, spent)
            for op in self._touches.seen(at):
                after = at & op.keep | op.put
                if op.touch < 0:
                    if after not in seen:
                        heappush(queue, (spent + weights[op.cost], after))
                    continue
                total = spent + weights[op.cost] + bound.get(after, INFINITE_KEY)
                if total < limit:
                    steps = self._steps(after)
                    if steps < self.steps_after.get(op.touch, NEVER):
                        self.steps_after[op.touch] = steps
                    if total < totals.get(op.touch, limit):
                        totals[op.touch] = total
        return without, totals

    def to_goal(self) -> dict[int, int]:
        """Least key to the goal without a touch, by projected state."""
        self._prepare()
        return self._backward([(0, at) for at, rest in self._bound.distances.items() if rest == 0])

    def through(self, need: int) -> dict[int, int]:
        """Least key to the goal with a first touch of a need, by projected state."""
        self._prepare()
        return self._backward(list(self._entries.get(need, ())))

    def _prepare(self) -> None:
        """Moves backward, and where touches of each need are possible, with the key from there."""
        if self._before:
            return
        for at in self._bound.distances:
            for op in self._touches.seen(at):
                after = at & op.keep | op.put
                rest = self._bound(after)
                if op.touch < 0:
                    self._before.setdefault(after, []).append((self._weights[op.cost], at))
                elif rest < INFINITE_KEY:
                    entry = (self._weights[op.cost] + rest, at)
                    self._entries.setdefault(op.touch, []).append(entry)

    def _backward(self, queue: list[tuple[int, int]]) -> dict[int, int]:
        heapify(queue)
        found: dict[int, int] = {}
        while queue:
            cost, at = heappop(queue)
            if at in found:
                continue
            found[at] = cost
            for weight, earlier in self._before.get(at, ()):
                if earlier not in found:
                    heappush(queue, (cost + weight, earlier))
        return found
