"""The human alone, by the kernel, to which an action is one step, however long it takes.

Beside no script nothing happens while an action of theirs goes on: what its epochs ask for and change is put
together, and it counts as so many actions of one epoch.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Final

from search.classical.planner import ClassicalPlanner
from search.classical.problem import classical_problem
from search.kernel.library import library
from search.packed.cost_vector import ACTIONS_BITS, INFINITE_KEY, own_costs, own_weights
from search.packed.operators import Operator, applicable, asked_by
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.options import MAX_EPOCH
from serendipity.model.resources.deadline import Deadline

_COUNT_BITS: Final = ACTIONS_BITS - MAX_EPOCH.bit_length()
"""For the number of actions, up to 4,095, beside one of epochs."""


class Chains:
    """The human's own actions from the first epoch to the last."""

    def __init__(self, packed: PackedTask) -> None:
        self._packed = packed
        self._due = {(field, value): op for field, value, op in packed.due if op.agents == packed.human_bit}
        going_on = {op.action for op in self._due.values()}
        self.whole = tuple(packed.chain(op) for op in packed.own if op.action not in going_on)

    def freed(self, state: int) -> tuple[int, tuple[Operator, ...]] | None:
        """The packed state in which the human has ended what they are at, and the rest of it.

        None where they can't go on with it.
        """
        rest: tuple[Operator, ...] = ()
        if self._due:
            begun = (self._due.get(at) for at in self._packed.assigned(self._busy, state))
            following = next((op for op in begun if op is not None), None)
            rest = () if following is None else self._packed.chain(following)
        for op in rest:
            if not applicable(op, state):
                return None
            state = state & op.keep | op.put
        return state, rest

    @cached_property
    def _busy(self) -> int:
        mask = 0
        for field, _ in self._due:
            mask |= field
        return mask

    def as_one(self, ops: Sequence[Operator]) -> Operator:
        """Ops that follow on each other, as one; one that no state allows where they can't."""
        first, *rest = ops
        need_mask, need, keep, put, forbidden = first[:5]
        for op in rest:
            asked = op.need_mask & keep
            ruled_out = any(put & field == value for field, value in op.forbidden if not field & keep)
            if ruled_out or (put ^ op.need) & op.need_mask & ~keep or (need ^ op.need) & need_mask & asked:
                field = next(self._packed.split(first.need_mask))  # it asks for a human who is free
                return first._replace(forbidden=((field, first.need & field),))
            forbidden += tuple((field, value) for field, value in op.forbidden if field & keep)
            need_mask, need = need_mask | asked, need | op.need & keep
            keep, put = keep & op.keep, put & op.keep | op.put
        for field in self._packed.split(need_mask & self._packed.all_ones & ~keep) if rest else ():
            if (need ^ put) & field == 0:  # the human is free again
                keep, put = keep | field, put & ~field
        return first._replace(need_mask=need_mask, need=need, keep=keep, put=put, forbidden=forbidden)


class OwnPlanner:
    """The kernel on the human's own problem; amounts are in the unit of :func:`.own_weights`.

    Args:
        planner: the kernel, on whole actions.
        chains: these, in the order of its operators.
        shift: bits below the number of epochs in what it adds up, for the number of actions, which decides
            between plans that are equal else.

    Attributes:
        planner: the same.
    """

    def __init__(self, planner: ClassicalPlanner, chains: Chains, packed: PackedTask, shift: int) -> None:
        self.planner = planner
        self._shift = shift
        self._chains = chains
        self._weights = own_weights(packed)
        self._spent = 0

    def cheapest(self, state: int, deadline: Deadline, limit: int = INFINITE_KEY) -> int:
        """See :class:`.ClassicalPlanner`."""
        freed = self._chains.freed(state)
        if freed is None:
            return INFINITE_KEY
        state, rest = freed
        self._spent = self._amount(rest)
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
        freed = self._chains.freed(state)
        if freed is None:
            return INFINITE_KEY
        return self._total(self.planner.bound(freed[0], deadline), self._amount(freed[1]))

    def first_plan(self, state: int, deadline: Deadline) -> tuple[int, ...] | None:
        """Some plan from a packed state, as ids of actions."""
        return self._plan(state, lambda free: self.planner.first_plan(free, deadline))

    def best_so_far(self, state: int) -> tuple[int, ...] | None:
        """The best plan from a packed state that is at hand, as ids of actions."""
        return self._plan(state, self.planner.best_so_far)

    def canonical(self, state: int, deadline: Deadline) -> tuple[int, ...] | None:
        """The cheapest plan from a packed state with the smallest actions, as ids of actions."""
        from search.classical.canonical import canonical_plan  # only here: most calls come by without

        return self._plan(state, lambda free: canonical_plan(self.planner, free, deadline))

    def counts(self) -> tuple[int, int, int]:
        """See :class:`.ClassicalPlanner`."""
        return self.planner.counts()

    def _plan(self, state: int, found: Callable[[int], Iterable[int] | None]) -> tuple[int, ...] | None:
        freed = self._chains.freed(state)
        numbers = None if freed is None else found(freed[0])
        if freed is None or numbers is None:
            return None
        whole = self._chains.whole
        return tuple(op.action for op in (*freed[1], *(op for number in numbers for op in whole[number])))

    def _amount(self, ops: Iterable[Operator]) -> int:
        return sum(self._weights[op.cost] for op in ops)

    def _total(self, amount: int, spent: int | None = None) -> int:
        if amount >= INFINITE_KEY:
            return amount
        cost, epochs = divmod(amount, 1 << ACTIONS_BITS)
        found = (cost << ACTIONS_BITS) + (epochs >> self._shift)
        return found + (self._spent if spent is None else spent)


def alone_planner(packed: PackedTask, goal: PackedGoal, deadline: Deadline) -> OwnPlanner | None:
    """The human alone, by the kernel; None without one that could.

    Args:
        deadline: asked for memory.
    """
    kernel, chains, costs = library(), Chains(packed), own_costs(packed)
    if kernel is None:
        return None
    operators = [chains.as_one(chain) for chain in chains.whole]
    kept = goal.mask
    for op in operators:
        kept |= asked_by(op) | packed.all_ones & ~op.keep
    fields = ((field, len(packed.values(field))) for field in packed.fields if field & kept)
    prices = [sum(costs[op.cost] for op in chain) for chain in chains.whole]
    shift = _COUNT_BITS if packed.due else 0
    sizes = ((len(chain) << shift) + bool(shift) for chain in chains.whole)
    problem = classical_problem(fields, operators, prices, goal, sizes)
    if problem is None:
        return None
    return OwnPlanner(ClassicalPlanner(kernel, problem, deadline), chains, packed, shift)
