"""A classical problem over packed states: operators, what each weighs, a goal.

An *amount* is a cost, as an integer, and a number of actions in the lowest bits: the cost decides.
A *weight* is an amount with the cost in the largest unit that all costs are multiples of.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import gcd
from typing import Final

from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal

ACTIONS_BITS: Final = 24
"""The cost is above these bits, the number of actions in them."""

_ACTIONS: Final = (1 << ACTIONS_BITS) - 1

NO_PLAN: Final = 2**63 - 1
"""The amount of what can't be done."""

_MOST_COST: Final = 1 << 20
"""Of one operator, in units of what all costs are multiples of, so that sums of many fit 64 bits."""


@dataclass(frozen=True, slots=True)
class ClassicalProblem:
    """What the kernel solves.

    Attributes:
        fields: masks of the fields that states differ in, with the number of their values.
        operators: what may be done.
        weights: of each operator: its cost in ``unit``, and one action.
        goal: what has to hold at the end.
        unit: what all costs are multiples of.
    """

    fields: tuple[tuple[int, int], ...]
    operators: tuple[Operator, ...]
    weights: tuple[int, ...]
    goal: PackedGoal
    unit: int

    @property
    def mask(self) -> int:
        """All fields."""
        return sum(field for field, _ in self.fields)

    def amount(self, weight: int) -> int:
        """A sum of weights with the cost in units of 1."""
        if weight >= NO_PLAN:
            return NO_PLAN
        return ((weight >> ACTIONS_BITS) * self.unit << ACTIONS_BITS) + (weight & _ACTIONS)

    def limit(self, amount: int) -> int:
        """The least weight of an amount that is not below this one."""
        if amount >= NO_PLAN:
            return NO_PLAN
        cost, actions = amount >> ACTIONS_BITS, amount & _ACTIONS
        whole, part = divmod(cost, self.unit)
        weight = whole + 1 << ACTIONS_BITS if part else (whole << ACTIONS_BITS) + actions
        return min(weight, NO_PLAN)


def classical_problem(
    fields: Iterable[tuple[int, int]], operators: Sequence[Operator], costs: Sequence[int], goal: PackedGoal
) -> ClassicalProblem | None:
    """A problem, or None where its costs are too far apart for the kernel's integers, or no state is a goal.

    Args:
        fields: masks of fields, with the number of their values.
        operators: what may be done; their fields are among them.
        costs: of each operator, as an integer, at least 0.
        goal: what has to hold at the end.
    """
    unit = gcd(*costs) or 1
    if goal.need < 0 or max(costs, default=0) // unit > _MOST_COST:
        return None
    weights = tuple((cost // unit << ACTIONS_BITS) + 1 for cost in costs)
    return ClassicalProblem(tuple(fields), tuple(operators), weights, goal, unit)
