"""A classical problem over packed states: operators, what each weighs, a goal.

An *amount* is a cost, as an integer, and a number of actions in the lowest bits: the cost decides.
A *weight* is an amount with the cost in the largest unit that all costs are multiples of: what the kernel,
whose integers have 64 bits, counts in.
"""

from collections.abc import Iterable, Sequence
from itertools import repeat
from math import gcd
from typing import Final, NamedTuple

from search.packed.cost_vector import ACTIONS_BITS, INFINITE_KEY, own_actions
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal

MOST_WEIGHT: Final = 1 << 61
"""``MOST_COST`` of ``search/kernel/values.h``: where the kernel's sums end."""

INFINITE_WEIGHT: Final = 2**63 - 1
"""``INFINITE_COST`` there."""


class ClassicalProblem(NamedTuple):
    """A classical problem with additive costs, as the kernel solves it.

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
        """A sum of weights with the cost in units of 1; ``INFINITE_KEY`` where the kernel has none."""
        if weight == INFINITE_WEIGHT:
            return INFINITE_KEY
        return ((weight >> ACTIONS_BITS) * self.unit << ACTIONS_BITS) + own_actions(weight)

    def limit(self, amount: int) -> int:
        """The least weight of an amount that is not below this one; no limit where the kernel's sums end."""
        cost, actions = amount >> ACTIONS_BITS, own_actions(amount)
        whole, part = divmod(cost, self.unit)
        weight = whole + 1 << ACTIONS_BITS if part else (whole << ACTIONS_BITS) + actions
        return weight if weight <= MOST_WEIGHT else INFINITE_WEIGHT


def classical_problem(
    fields: Iterable[tuple[int, int]],
    operators: Sequence[Operator],
    costs: Sequence[int],
    goal: PackedGoal,
    sizes: Iterable[int] = repeat(1),
) -> ClassicalProblem | None:
    """A problem, or None where its costs are too far apart for the kernel's integers, or no state is a goal.

    Args:
        fields: masks of fields, with the number of their values.
        operators: what may be done; their fields are among them.
        costs: of each operator, as an integer, at least 0.
        sizes: of each operator the number of its actions.
    """
    unit = gcd(*costs) or 1
    weights = tuple((cost // unit << ACTIONS_BITS) + size for cost, size in zip(costs, sizes, strict=False))
    if goal.need < 0 or sum(weights) >= MOST_WEIGHT:
        return None
    return ClassicalProblem(tuple(fields), tuple(operators), weights, goal, unit)
