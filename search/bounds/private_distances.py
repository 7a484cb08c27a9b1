"""The human's side of help: their way to each touch, and on to the goal, in their private fields."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from search.bounds.interactions import Interactions, Seen
from search.engine.shortest_paths import LevelQueue, backward
from search.human.pattern_database import PatternDatabase, Predecessors
from search.packed.cost_vector import INFINITE_KEY, NEVER, Weights, own_weights
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline

_MOST_KEPT = 200_000
"""Distances that are kept with a prepared task, some tens of megabytes."""


class Corridor:
    """The human's ways from some states up to a first touch, within a limit.

    Attributes:
        without: least total to the goal without a touch.
        totals: least total by the need of the first touch.
        before: per state the moves that lead to it: weight, state before it.
        entries: per need its first touches: what they cost to the goal, they included, and from where.
    """

    def __init__(self, deadline: Deadline) -> None:
        self._deadline = deadline
        self.without = INFINITE_KEY
        self.totals: dict[int, int] = {}
        self.before: dict[int, list[tuple[int, int]]] = {}
        self.entries: dict[int, list[tuple[int, int]]] = {}

    def through(self, need: int) -> dict[int, int]:
        """Least key to the goal with a first touch of a need, by projected state."""
        return backward(self.entries.get(need, ()), [self.before], self._deadline)


@dataclass(eq=False)
class PrivateDistances:
    """Distances by moves alone, up to a first touch.

    Attributes:
        own: the human's ways backward, asked for where they are needed.
        interactions: what their ops mention.
        bound: private distances to the goal.
        steps: the same, counting actions.
        weights: key increments of the call.
        deadline: polled at each state that comes up.
        outside: the fields that others change.
        steps_after: least number of actions to the goal after a touch, by its need, over
            the touches that :meth:`explore` has met.
    """

    own: Callable[[Deadline], "OwnPrivateDistances"]
    interactions: Interactions
    bound: PatternDatabase
    steps: PatternDatabase
    weights: Weights
    deadline: Deadline

    def __post_init__(self) -> None:
        self.outside = self.interactions.outside
        self.steps_after: dict[int, int] = {}

    def explore(self, sources: Sequence[tuple[int, int]], limit: int) -> Corridor:
        """From several states, each with what has been spent there, in that order, below a limit."""
        found = Corridor(self.deadline)
        bound = self.bound.distances
        queue = LevelQueue((spent, state & self.interactions.mask) for spent, state in sources)
        seen: set[int] = set()
        for spent, level in queue:
            for at in sorted(level):  # in this order needs are met, and numbered
                if at in seen:
                    continue
                seen.add(at)
                self.deadline.check()  # touches of one state may be hundreds
                rest = bound.get(at, INFINITE_KEY)
                if spent + rest >= limit:
                    continue
                if rest == 0:
                    found.without = min(found.without, spent)
                for weight, after in self._leave(at, spent, found, limit):
                    if after not in seen:
                        queue.push(spent + weight, after)
        return found

    def _leave(self, at: int, spent: int, found: Corridor, limit: int) -> list[tuple[int, int]]:
        """The human's moves from a projected state: weight, state after it.

        They are recorded in ``found``, and so is what else they can do.
        """
        bound, actions, weights = self.bound.distances, self.steps.distances, self.weights.human
        moves = []
        for op in self.interactions.seen(at):
            after = at & op.keep | op.put
            weight = weights[op.cost]
            if op.interaction < 0:
                found.before.setdefault(after, []).append((weight, at))
                moves.append((weight, after))
                continue
            rest = weight + bound.get(after, INFINITE_KEY)
            if spent + rest < limit:
                found.entries.setdefault(op.interaction, []).append((rest, at))
                if spent + rest < found.totals.get(op.interaction, INFINITE_KEY):
                    found.totals[op.interaction] = spent + rest
                steps = actions.get(after, INFINITE_KEY)
                if steps < self.steps_after.get(op.interaction, NEVER):
                    self.steps_after[op.interaction] = steps
        return moves

    def to_goal(self) -> dict[int, int]:
        """Least key to the goal without a touch, by projected state."""
        return self.weights.of_own(self.own(self.deadline).to_goal(self.deadline))

    def through(self, need: int) -> dict[int, int]:
        """Least key to the goal with a first touch of a need, by projected state."""
        return self.weights.of_own(self.own(self.deadline).through(need, self.deadline))


class OwnPrivateDistances:
    """The human's ways backward, in the unit of :func:`.own_weights`.

    Args:
        interactions: what their ops mention.
        distances: to the goal, by projected state.
        moves: what leads to each projected state without an interaction.
    """

    def __init__(
        self,
        packed: PackedTask,
        interactions: Interactions,
        distances: Mapping[int, int],
        moves: Predecessors,
    ) -> None:
        self._weights = own_weights(packed)
        self._interactions = interactions
        self._distances = distances
        self._moves = moves
        self._field = packed.own_index.field & interactions.mask
        self._by_value: dict[int, list[int]] = {}
        for at in self._distances:
            self._by_value.setdefault(at & self._field, []).append(at)
        self._to_goal: dict[int, int] | None = None
        self._through: dict[int, dict[int, int]] = {}

    def to_goal(self, deadline: Deadline) -> dict[int, int]:
        """Least cost to the goal without a touch, by projected state."""
        if self._to_goal is None:
            goals = [(0, at) for at, rest in self._distances.items() if rest == 0]
            self._to_goal = backward(goals, [self._moves], deadline)
        return self._to_goal

    def through(self, need: int, deadline: Deadline) -> dict[int, int]:
        """Least cost to the goal with a first touch of a need, by projected state."""
        found = self._through.get(need)
        if found is None:
            if len(self._through) * len(self._distances) > _MOST_KEPT:
                self._through.clear()
            found = self._through[need] = backward(self._entries(need), [self._moves], deadline)
        return found

    def _entries(self, need: int) -> Iterator[tuple[int, int]]:
        """What a touch of a need costs to the goal, it included, and where it is possible."""
        for op in self._interactions.of(need):
            weight = self._weights[op.cost]
            for at in self._where(op):
                rest = self._distances.get(at & op.keep | op.put)
                if rest is not None and at & op.need_mask == op.need:
                    yield weight + rest, at

    def _where(self, op: Seen) -> Iterable[int]:
        """Projected states in which an op may be possible."""
        if op.need_mask & self._field:
            return self._by_value.get(op.need & self._field, ())
        return self._distances
