"""The human's side of help: their way to each touch, and on to the goal, in their private fields."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final

from search.bounds.interactions import Interactions
from search.engine.shortest_paths import LevelQueue, backward
from search.human.pattern_database import PatternDatabase
from search.packed.cost_vector import INFINITE_KEY, NEVER, Weights
from serendipity.model.resources.deadline import Deadline

UNTOUCHED: Final = -1
"""In place of a need: the human gets to their goal without a touch."""


class Corridor:
    """The human's ways from some states up to a first touch, within a limit.

    Attributes:
        without: least total to the goal without a touch.
        totals: least total by the need of the first touch.
        before: per state the moves that lead to it: weight, state before it.
        entries: per need its first touches: what they cost to the goal, they included, and from where.
    """

    def __init__(self) -> None:
        self.without = INFINITE_KEY
        self.totals: dict[int, int] = {}
        self.before: dict[int, list[tuple[int, int]]] = {}
        self.entries: dict[int, list[tuple[int, int]]] = {}


def ways_through(corridors: Sequence[Corridor], need: int, deadline: Deadline) -> dict[int, int]:
    """Least key to the goal with a first touch of a need, by the projected states of some corridors."""
    entries = chain.from_iterable(corridor.entries.get(need, ()) for corridor in corridors)
    return backward(entries, [corridor.before for corridor in corridors], deadline)


@dataclass(eq=False)
class PrivateDistances:
    """Distances by moves alone, up to a first touch.

    Attributes:
        interactions: what their ops mention.
        bound: private distances to the goal.
        steps: the same, counting actions.
        weights: key increments of the call.
        outside: the fields that others change.
        steps_after: least number of actions to the goal after a touch, by its need, over
            the touches that :meth:`explore` has met.
    """

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
        found = Corridor()
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
                    found.entries.setdefault(UNTOUCHED, []).append((0, at))
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
