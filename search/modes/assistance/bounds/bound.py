"""A lower bound on the value of a state: both together, without turns.

Where the states that the two can reach together are few, the joint optimum itself, from
one table.  Elsewhere a relaxation of it, see :mod:`search.modes.assistance.bounds.relaxed_provision`.
"""

from search.modes.assistance.bounds.relaxed_provision import RelaxedProvision
from search.modes.assistance.distances.closure import SMALL, Arc, Closure, ClosureTooLargeError
from search.modes.assistance.game.game import Game
from search.packed.cost_vector import INFINITE_KEY
from search.packed.packed_task import PackedGoal


class ValueBound:
    """Admissible and consistent; the same whoever is to move."""

    def __init__(self, game: Game) -> None:
        self._unit_bits = game.unit_bits
        self._provision = RelaxedProvision(game)
        heaviest = max(map(game.cost, game.supporter_ops), default=0)
        self._shift = heaviest.bit_length() + SMALL.bit_length()  # a way has no state twice
        self._joint: Closure | None = _joint_closure(game, self._shift)
        try:
            self._joint.key(game.init)
        except ClosureTooLargeError:
            self._joint = None

    def __call__(self, state: int) -> int:
        """A value that no policy undercuts from ``state``."""
        if self._joint is None:
            return self._provision(state)
        key = self._joint.key(state)
        if key >= INFINITE_KEY:
            return INFINITE_KEY
        prime, supporter = divmod(key, 1 << self._shift)
        return (prime << self._unit_bits) + supporter

    def wanted(self, state: int) -> frozenset[int]:
        """Supporter actions that a plan attaining the bound makes use of; may be empty."""
        return frozenset() if self._joint is not None else self._provision.wanted(state)


def _joint_closure(game: Game, shift: int) -> Closure:
    """Distances of both together; ``shift`` is the lowest bit of what the prime pays."""
    arcs = []
    for ops, bit in ((game.packed.own, shift), (game.supporter_ops, 0)):
        for op in ops:
            game.deadline.tick()
            condition = PackedGoal(op.need_mask, op.need, op.forbidden)
            arcs.append(Arc(condition, op.keep, op.put, game.cost(op) << bit))
    fields = {field: game.packed.values(field) for field in game.packed.fields}
    return Closure(arcs, game.goal, fields, SMALL, game.deadline)
