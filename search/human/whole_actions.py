"""The human alone, by the kernel, to which an action is one step, however long it takes.

Beside no script nothing happens while an action of theirs goes on: what its epochs ask for and change is put
together, and it counts as so many actions of one epoch.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Final

from search.classical.planner import ClassicalPlanner
from search.classical.problem import classical_problem
from search.kernel.library import library
from search.packed.cost_vector import ACTIONS_BITS, INFINITE_KEY, own_costs, own_weights
from search.packed.due import Due, as_one
from search.packed.operators import Operator, union
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.options import MAX_EPOCH
from serendipity.model.resources.deadline import Deadline

_COUNT_BITS: Final = ACTIONS_BITS - MAX_EPOCH.bit_length()
"""For the number of actions, up to 4,095, beside one of epochs."""


class OwnPlanner:
    """The kernel on the human's own problem; amounts are in the unit of :func:`.own_weights`.

    Args:
        planner: the kernel, on whole actions.
        chains: these from the first epoch to the last, in the order of its operators.
        shift: bits below the number of epochs in what it adds up, for the number of actions, which decides
            between plans that are equal else.
    """

    def __init__(
        self, planner: ClassicalPlanner, chains: Sequence[Sequence[Operator]], packed: PackedTask, shift: int
    ) -> None:
        weights = own_weights(packed)
        self.planner = planner
        self._shift = shift
        self._chains = chains
        self._due = Due(packed, lambda op: weights[op.cost], strict=True)
        self._spent = 0
        self._canonical: dict[int, tuple[int, ...] | None] = {}

    def cheapest(self, state: int, deadline: Deadline, limit: int = INFINITE_KEY) -> int:
        """See :class:`.ClassicalPlanner`."""
        freed = self._due.finished(state)
        if freed is None:
            return INFINITE_KEY
        state, self._spent, _ = freed
        if limit <= self._spent:
            return limit
        left = limit
        if limit < INFINITE_KEY:
            cost, epochs = divmod(limit - self._spent, 1 << ACTIONS_BITS)
            left = (cost << ACTIONS_BITS) + (epochs << self._shift)
        return self._total(self.planner.cheapest(state, deadline, left))

    @property
    def least(self) -> int:
        """See :class:`.ClassicalPlanner`."""
        return self._total(self.planner.least)

    def bound(self, state: int, deadline: Deadline) -> int:
        """See :class:`.ClassicalPlanner`."""
        freed = self._due.finished(state)
        if freed is None:
            return INFINITE_KEY
        return self._total(self.planner.bound(freed[0], deadline), freed[1])

    def first_plan(self, state: int, deadline: Deadline) -> tuple[int, ...] | None:
        """Some plan from a packed state, as ids of actions."""
        return self._plan(state, lambda free: self.planner.first_plan(free, deadline))

    def best_so_far(self, state: int) -> tuple[int, ...] | None:
        """The best plan from a packed state that is at hand, as ids of actions."""
        return self._plan(state, self.planner.best_so_far)

    def canonical(self, state: int, deadline: Deadline) -> tuple[int, ...] | None:
        """The cheapest plan from a packed state with the smallest actions, as ids of actions."""
        from search.classical.canonical import canonical_plan  # only here: most calls come by without

        if state not in self._canonical:
            found = self._plan(state, lambda free: canonical_plan(self.planner, free, deadline))
            self._canonical[state] = found
        return self._canonical[state]

    def _plan(self, state: int, found: Callable[[int], Iterable[int] | None]) -> tuple[int, ...] | None:
        freed = self._due.finished(state)
        numbers = None if freed is None else found(freed[0])
        if freed is None or numbers is None:
            return None
        return (*freed[2], *(op.action for number in numbers for op in self._chains[number]))

    def _total(self, amount: int, spent: int | None = None) -> int:
        if amount >= INFINITE_KEY:
            return amount
        cost, epochs = divmod(amount, 1 << ACTIONS_BITS)
        found = (cost << ACTIONS_BITS) + (epochs >> self._shift)
        return found + (self._spent if spent is None else spent)


def alone_planner(packed: PackedTask, goal: PackedGoal, deadline: Deadline) -> OwnPlanner | None:
    """The human alone, by the kernel; None without one that could."""
    kernel, costs = library(), own_costs(packed)
    if kernel is None:
        return None
    going_on = {op.action for _, _, op in packed.due}
    chains = [packed.chain(op) for op in packed.own if op.action not in going_on]
    operators = [as_one(packed, chain) for chain in chains]
    kept = goal.mask | union(map(packed.mentioned, operators))
    fields = ((field, len(packed.values(field))) for field in packed.fields if field & kept)
    prices = [sum(costs[op.cost] for op in chain) for chain in chains]
    shift = _COUNT_BITS if packed.due else 0
    sizes = ((len(chain) << shift) + bool(shift) for chain in chains)
    problem = classical_problem(fields, operators, prices, goal, sizes)
    if problem is None:
        return None
    return OwnPlanner(ClassicalPlanner(kernel, problem, deadline), chains, packed, shift)
