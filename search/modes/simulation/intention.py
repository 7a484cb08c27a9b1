"""Intentions: the rest of the human's current plan (``rho`` of semantics 6)."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from search.packed.cost_vector import CostLayout
from search.packed.joint_actions import NOTHING, JointAction, as_option
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask


@dataclass(eq=False)
class Intention:
    """A sequence of the human's own actions; one object for each sequence.

    Attributes:
        op: the first action, packed; None at the end.
        option: what it does; nothing at the end.
        weight: key increment of all its actions.
        cost: their cost, scaled.
        after: the intention after it; None at the end.
    """

    op: Operator | None = None
    option: JointAction = NOTHING
    weight: int = 0
    cost: int = 0
    after: "Intention | None" = None

    @property
    def rest(self) -> "Intention":
        """What remains after the first action."""
        return self.after or self

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
        self._end = Intention()
        self._known: dict[tuple[int, Intention], Intention] = {}  # by the first action, and what is left

    def of(self, actions: Iterable[int]) -> Intention:
        """The intention to do these actions, one after another."""
        found = self._end
        for action in reversed(tuple(actions)):
            key = action, found
            if key not in self._known:
                op = self._packed.op(action)
                weight = self._weights[op.cost]
                cost = found.cost + self._keys.scaled_cost(weight)
                option, total = as_option(op, weight), found.weight + weight
                self._known[key] = Intention(op, option, total, cost, found)
            found = self._known[key]
        return found
