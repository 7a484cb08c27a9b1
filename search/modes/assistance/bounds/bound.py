"""Lower bounds on the value of a state: both together, without turns.

Where the states that the two can reach together are few, the joint optimum itself, from
one table.  Elsewhere a relaxation of it, see :mod:`search.modes.assistance.bounds.relaxed_provision`.
Where the prime's optimal costs are out of reach, the joint optimum without deletes.
"""

from collections.abc import Mapping

from search.engine.and_or import AndOrGraph, Rule
from search.modes.assistance.bounds.relaxed_provision import RelaxedProvision
from search.modes.assistance.distances.closure import SMALL, Arc, Closure, ClosureTooLargeError
from search.modes.assistance.game.game import Game
from search.packed.cost_vector import INFINITE_KEY
from search.packed.packed_task import PackedGoal
from serendipity.model.resources.deadline import Deadline


class ValueBound:
    """Admissible and consistent; the same whoever is to move."""

    def __init__(self, game: Game) -> None:
        self._provision = RelaxedProvision(game)
        self._joint: Closure | None = _joint_closure(game)
        try:
            self._joint.key(game.init)
        except ClosureTooLargeError:
            self._joint = None

    def __call__(self, state: int) -> int:
        """A value that no policy undercuts from ``state``."""
        return self._provision(state) if self._joint is None else self._joint.key(state)

    def wanted(self, state: int) -> frozenset[int]:
        """Supporter actions that a plan attaining the bound makes use of; may be empty."""
        return frozenset() if self._joint is not None else self._provision.wanted(state)


def _joint_closure(game: Game) -> Closure:
    """Distances of both together, in values."""
    arcs = []
    for ops, bit in ((game.packed.own, game.unit_bits), (game.supporter_ops, 0)):
        for op in game.deadline.each(ops):
            condition = PackedGoal(op.need_mask, op.need, op.forbidden)
            arcs.append(Arc(condition, op.keep, op.put, game.cost(op) << bit))
    fields = {field: game.packed.values(field) for field in game.packed.fields}
    return Closure(arcs, game.goal, fields, SMALL, game.deadline)


def joint_lower_bound(game: Game, deadline: Deadline) -> int:
    """A value that no policy undercuts from the initial state; :class:`LimitReachedError` at the deadline.

    A fact costs what the dearest of what it takes costs (h_max, Bonet and Geffner 2001).
    """
    task = game.task
    shifts: dict[tuple[int, ...], int] = {(task.human,): game.unit_bits, (task.robots[0],): 0}
    rules, values = [], []
    for action in deadline.each(task.actions):
        shift = shifts.get(action.participants)
        if shift is not None:
            rules.append(Rule(action.pre, action.add))
            values.append(int(action.cost * game.scale) << shift)

    def value(k: int, costs: Mapping[int, int]) -> int:
        return max((costs[fact] for fact in rules[k].tails), default=0) + values[k]

    costs, _ = AndOrGraph(rules, deadline).settle(task.init, value, INFINITE_KEY)
    return max((costs.get(fact, INFINITE_KEY) for fact in task.goal.positive), default=0)
