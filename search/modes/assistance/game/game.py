"""The game of silent assistance (semantics 7), packed: who may do what, and what it costs.

A *value* is one integer, ``prime * unit + supporter``: adding values adds both costs,
comparing them compares lexicographically.  Costs are scaled to integers.
"""

from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Final, NamedTuple

from search.call.prepared_task import PreparedTask
from search.modes.assistance.game.own import OwnCosts, applicable_ops, by_rarest
from search.packed.cost_vector import ACTIONS_BITS, INFINITE_KEY, require_room
from search.packed.operators import Operator, asked_by, union
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import HumanPlan

_RUN_BITS: Final = 40
"""A run has fewer than so many bits' steps."""

NOOP: Final = -1
"""The id under which waiting is listed."""


class Move(NamedTuple):
    """A move of one of the two: its value, the state after it, the action's id."""

    value: int
    after: int
    action: int


class Game:
    """Supporter and prime, moving in turn.

    Args:
        prepared: a task of one human (the prime) and exactly one robot (the supporter); joint actions
            are nobody's move.
        own_deadline: polled while the prime's own optimum is worked out; default ``deadline``.
    """

    def __init__(
        self, prepared: PreparedTask, deadline: Deadline, own_deadline: Deadline | None = None
    ) -> None:
        task = prepared.task
        assert len(task.robots) == 1, "the facade has checked that"
        if task.robot_goal:
            prepared = prepared.with_goal(task.goal, Condition())
        self.prepared = prepared
        self.task = prepared.task
        self.deadline = deadline
        self._own_deadline = own_deadline or deadline
        self.packed: PackedTask = prepared.plain(deadline).packed
        self.goal = self.packed.goal
        self.scale = lcm(1, *(cost.denominator for cost in self.packed.costs))
        self._scaled = [int(cost * self.scale) for cost in self.packed.costs]
        self.unit_bits = max(self._scaled, default=0).bit_length() + _RUN_BITS
        require_room(2 * self.unit_bits)
        robot = 1 << task.robots[0]
        alone = tuple(op for op in self.packed.others if op.agents == robot)
        self._relevant = _relevant(self.packed, (*self.packed.own, *alone))
        self.init = self.packed.init & self._relevant
        self.supporter_ops = tuple(op for op in alone if ~op.keep & self._relevant)
        self._supporter_index = by_rarest(self.packed, self.supporter_ops, deadline)
        self._prime_moves: dict[int, tuple[Move, ...]] = {}

    @cached_property
    def own(self) -> OwnCosts:
        """The prime alone."""
        return OwnCosts(self.packed, self._scaled, self._own_deadline)

    def forget_own(self) -> None:
        """Drop what was found about the prime alone, which may be what fills the memory."""
        with suppress(AttributeError):  # nothing has been
            del self.own

    def cost(self, op: Operator) -> int:
        """Scaled cost of an op."""
        return self._scaled[op.cost]

    def pair(self, value: int) -> tuple[Fraction, Fraction]:
        """The costs of prime and supporter in a value."""
        prime, supporter = divmod(value, 1 << self.unit_bits)
        return Fraction(prime, self.scale), Fraction(supporter, self.scale)

    def supporter(self, state: int) -> list[Move]:
        """What the supporter may do, waiting first; of moves to one state the cheapest."""
        found = {state: Move(0, state, NOOP)}
        for op in applicable_ops(self._supporter_index, state):
            after, cost = (state & op.keep | op.put) & self._relevant, self._scaled[op.cost]
            if after not in found or cost < found[after].value:
                found[after] = Move(cost, after, op.action)
        return list(found.values())

    def prime(self, state: int) -> tuple[Move, ...]:
        """The prime's optimal actions, smallest name first; empty if they have no plan alone.

        The goal does not hold in ``state``.
        """
        moves = self._prime_moves.get(state)
        if moves is None:
            found: dict[tuple[str, int], Move] = {}
            for op, after in self.own.optimal(state):
                move = Move(self._scaled[op.cost] << self.unit_bits, after & self._relevant, op.action)
                found.setdefault((self.packed.task.actions[op.action].name, after), move)
            moves = self._prime_moves[state] = tuple(found.values())
        return moves

    def alone(self, state: int) -> int:
        """The value if the supporter does nothing for ever; ``INFINITE_KEY`` if that does not end.

        Whatever the prime chooses among their optimal actions, they pay their optimal cost.
        """
        key = self.own.key(state)
        return INFINITE_KEY if key >= INFINITE_KEY else key >> ACTIONS_BITS << self.unit_bits

    def value_alone(self, plan: HumanPlan) -> int:
        """The value of a plan of the prime's: what the supporter's doing nothing is worth at most."""
        return sum(int(self.task.actions[i].cost * self.scale) for i in plan) << self.unit_bits


def _relevant(packed: PackedTask, ops: Sequence[Operator]) -> int:
    """The fields on which the goal depends; what only joint actions ask for is none of them."""
    found, before = packed.goal.mask, 0
    while found != before:
        before = found
        found |= union(asked_by(op) for op in ops if ~op.keep & before)
    return found
