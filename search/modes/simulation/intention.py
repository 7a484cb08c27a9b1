"""Intentions: the rest of the human's current plan (``rho`` of semantics 6)."""

from collections.abc import Iterable
from functools import cached_property

from search.packed.cost_vector import CostLayout
from search.packed.joint_actions import NOTHING, JointAction, as_option
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask


class Intention:
    """A sequence of the human's own actions; one object for each sequence.

    Attributes:
        number: tells intentions apart.
        op: the first action, packed; None at the end.
        option: what it does; nothing at the end.
        rest: the intention after it; itself at the end.
        weight: key increment of all its actions.
        cost: their cost, scaled.
    """

    def __init__(
        self,
        number: int,
        op: Operator | None,
        option: JointAction,
        rest: "Intention | None",
        weight: int,
        cost: int,
    ) -> None:
        self.number, self.op, self.option = number, op, option
        self._rest, self.weight, self.cost = rest, weight, cost

    @property
    def rest(self) -> "Intention":
        """What remains after the first action."""
        return self._rest or self

    @cached_property
    def actions(self) -> tuple[int, ...]:
        """Action ids, in order."""
        found: list[int] = []
        at = self
        while at.op is not None:
            found += at.option.actions
            at = at.rest
        return tuple(found)


class Intentions:
    """Makes intentions, each sequence once."""

    def __init__(self, packed: PackedTask, keys: CostLayout, weights: list[int]) -> None:
        self._packed = packed
        self._keys = keys
        self._weights = weights
        self._end = Intention(0, None, NOTHING, None, 0, 0)
        self._known: dict[tuple[int, int], Intention] = {}  # by the first action, and what remains after it

    def of(self, actions: Iterable[int]) -> Intention:
        """The intention to do these actions, one after another."""
        found = self._end
        for action in reversed(tuple(actions)):
            key = action, found.number
            if key not in self._known:
                op, number = self._packed.op(action), len(self._known) + 1
                weight = self._weights[op.cost]
                cost = found.cost + self._keys.scaled_cost(weight)
                option, total = as_option(op, weight), found.weight + weight
                self._known[key] = Intention(number, op, option, found, total, cost)
            found = self._known[key]
        return found
