"""Intentions: the rest of the human's current plan (``rho`` of semantics 6)."""

from dataclasses import dataclass
from functools import cached_property

from search.packed.joint_actions import NOTHING, JointAction
from search.packed.operators import Operator


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
