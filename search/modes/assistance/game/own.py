"""The prime alone: their optimal (cost, length) from any state of the game.

Facts that they do not change themselves are the *context* of their search; for each context
a table over the rest is filled in where it is asked for.
"""

from collections import Counter
from collections.abc import Sequence
from functools import cached_property
from operator import attrgetter
from typing import Final

from search.human.individual_planner import IndividualPlanner, Memory
from search.human.pattern_database import NOTHING_KNOWN
from search.modes.assistance.distances.closure import Arc, Closure, ClosureTooLargeError
from search.packed.cost_vector import ACTIONS_BITS, INFINITE_KEY
from search.packed.operator_index import LiteralIndex
from search.packed.operators import Operator, applicable
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.resources.deadline import Deadline

MAX_STATES: Final = 100_000
"""The largest table of one context, unless it has a ball; beyond it each state is searched by itself."""


class OwnCosts:
    """The prime's optimal keys ``cost << ACTIONS_BITS | length``, with the supporter idle.

    Args:
        scaled: integer cost by the index of an op's cost.
    """

    def __init__(self, packed: PackedTask, scaled: list[int], deadline: Deadline) -> None:
        self._packed = packed
        self._deadline = deadline
        self._weights = [(cost << ACTIONS_BITS) + 1 for cost in scaled]
        self._changed = packed.changed_by(packed.own)
        self._mask = packed.own_mask | packed.goal.mask
        self._context: dict[int, Closure | None] = {}
        self._index = by_rarest(packed, packed.own, deadline)
        self._too_large = False

    def key(self, state: int, limit: int = INFINITE_KEY) -> int:
        """The prime's optimal key; ``INFINITE_KEY`` without a plan; at or above ``limit`` any such value."""
        context = state & self._mask & ~self._changed
        if context not in self._context:
            self._context[context] = self._table(context)
        table = self._context[context]
        if table is None:
            return INFINITE_KEY
        if not self._too_large:
            try:
                return table.key(state & self._changed, limit)
            except ClosureTooLargeError:
                self._too_large = True
        return self._single.key(state, limit)

    def optimal(self, state: int) -> list[tuple[Operator, int]]:
        """Actions that start an optimal plan, ascending, with their successors."""
        key = self.key(state)
        if key >= INFINITE_KEY:
            return []
        found = []
        for op in applicable_ops(self._index, state):
            after, rest = state & op.keep | op.put, key - self._weights[op.cost]
            if after != state and self.key(after, rest + 1) == rest:
                found.append((op, after))
        return found

    def _table(self, context: int) -> Closure | None:
        """The table of a context, still empty; None where the context denies the goal."""
        changed = self._changed
        goal = _within(self._packed.goal, changed, context)
        if goal is None:
            return None
        arcs = []
        for op in self._deadline.each(self._packed.own):
            condition = _within(PackedGoal(op.need_mask, op.need, op.forbidden), changed, context)
            if condition is not None:
                arcs.append(Arc(condition, op.keep, op.put, self._weights[op.cost]))
        fields = {field: self._packed.values(field) for field in self._packed.fields if field & changed}
        return Closure(arcs, goal, fields, MAX_STATES, self._deadline)

    @cached_property
    def _single(self) -> IndividualPlanner:
        """What searches each state by itself."""
        packed, weights = self._packed, self._weights
        memory = Memory(packed, lambda op: weights[op.cost])
        return IndividualPlanner(packed, packed.goal, NOTHING_KNOWN, memory, self._deadline)


def _within(condition: PackedGoal, changed: int, context: int) -> PackedGoal | None:
    """The part of a condition on the ``changed`` fields; None if the context denies the rest."""
    rest = condition.need_mask & ~changed
    if condition.need < 0 or context & rest != condition.need & rest:
        return None
    if any(context & field == value for field, value in condition.forbidden if not field & changed):
        return None
    return condition.within(changed)


def by_rarest(packed: PackedTask, ops: Sequence[Operator], deadline: Deadline) -> LiteralIndex[Operator]:
    """Each op under one field and value that it asks for: of these the rarest.

    Where many fields matter (a place each, say), no single field tells ops apart.
    """
    asked = [list(packed.assigned(op.need_mask, op.need)) for op in deadline.each(ops)]
    count = Counter(pair for pairs in asked for pair in pairs)
    index: LiteralIndex[Operator] = LiteralIndex()
    for op, pairs in zip(ops, asked, strict=True):
        index.add(*min(pairs, key=count.__getitem__, default=(0, 0)), op)
    return index


def applicable_ops(index: LiteralIndex[Operator], state: int) -> list[Operator]:
    """What is possible in a packed state, in the order of the actions."""
    return sorted((op for op in index.candidates(state) if applicable(op, state)), key=attrgetter("action"))
