"""Sets of packed states as decision diagrams, and what operators make of them.

Each bit of a state is two variables of the diagrams, one for before and one for after an operator, next to
each other.  Operators that weigh the same are one relation as long as its diagram is small (Torralba et
al., Efficient symbolic search for cost-optimal planning, 2017).
"""

from collections import defaultdict
from collections.abc import Iterable
from functools import reduce
from operator import or_
from typing import Final, NamedTuple

from oxidd.bcdd import BCDDFunction as Diagram
from oxidd.bcdd import BCDDManager, BCDDSubstitution
from oxidd.util import BooleanOperator

from search.classical.problem import ClassicalProblem
from search.classical.symbolic.variable_order import variable_order
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal

_MOST_NODES: Final = 8_000_000
"""Nodes of all diagrams: about 350 MiB; where there would be more, the search gives up."""

_CACHE: Final = 1 << 22
_MOST_MERGED: Final = 100_000
"""Nodes of a relation of several operators."""


class _Relation(NamedTuple):
    """Some operators: the states before and after each, over the bits that they set."""

    diagram: Diagram
    sets: int


class _Step(NamedTuple):
    """A relation, ready to be used."""

    diagram: Diagram
    before: Diagram
    after: Diagram
    to_before: BCDDSubstitution
    to_after: BCDDSubstitution


class StateSets:
    """Sets of states of a problem.

    Attributes:
        weights: the different weights of operators, ascending.

    Raises:
        MemoryError: there are too many nodes; so do all methods.
    """

    def __init__(self, problem: ClassicalProblem) -> None:
        masks = [field for field, _ in problem.fields]
        order = variable_order(masks, problem.operators)
        each = (masks[number] for number in order)
        self._bits = [bit for mask in each for bit in range(mask.bit_length()) if mask >> bit & 1]
        self._manager = BCDDManager(_MOST_NODES, _CACHE, 1)
        self._manager.add_vars(2 * len(self._bits))
        self._before = {bit: self._manager.var(2 * at) for at, bit in enumerate(self._bits)}
        self._after = {bit: self._manager.var(2 * at + 1) for at, bit in enumerate(self._bits)}
        self._mask = problem.mask
        self.none = self._manager.false()
        steps: dict[int, list[_Relation]] = defaultdict(list)
        for op, weight in zip(problem.operators, problem.weights, strict=True):
            steps[weight].append(self._relation(op))
        self._steps = {weight: [*map(self._ready, self._merged(steps[weight]))] for weight in sorted(steps)}
        self.weights = tuple(self._steps)

    def state(self, state: int) -> Diagram:
        """A single state."""
        return self._fixed(self._mask, state, self._before)

    def goal(self, goal: PackedGoal) -> Diagram:
        """All states that satisfy a condition."""
        return self._without(self._fixed(goal.need_mask, goal.need, self._before), goal.forbidden)

    def contains(self, states: Diagram, state: int) -> bool:
        """Whether a state is in a set."""
        return states.eval((2 * at, bool(state >> bit & 1)) for at, bit in enumerate(self._bits))

    def image(self, states: Diagram, weight: int) -> Diagram:
        """The states that operators of a weight lead to from some."""
        found = (
            step.diagram.apply_exists(BooleanOperator.AND, states, step.before).substitute(step.to_before)
            for step in self._steps[weight]
        )
        return reduce(or_, found, self.none)

    def preimage(self, states: Diagram, weight: int) -> Diagram:
        """The states from which operators of a weight lead to some."""
        found = (
            step.diagram.apply_exists(BooleanOperator.AND, states.substitute(step.to_after), step.after)
            for step in self._steps[weight]
        )
        return reduce(or_, found, self.none)

    def _relation(self, op: Operator) -> _Relation:
        sets = ~op.keep & self._mask
        asked = self._without(self._fixed(op.need_mask, op.need, self._before), op.forbidden)
        return _Relation(asked & self._fixed(sets, op.put, self._after), sets)

    def _merged(self, relations: Iterable[_Relation]) -> list[_Relation]:
        """The same relations, neighbours as one for as long as that is small."""
        merged, count = sorted(relations, key=lambda relation: relation.sets), 0
        while len(merged) != count:
            count = len(merged)
            merged = [one for at in range(0, count, 2) for one in self._as_one(merged[at : at + 2])]
        return merged

    def _as_one(self, some: list[_Relation]) -> list[_Relation]:
        sets = reduce(or_, (relation.sets for relation in some))
        parts = [relation.diagram & self._kept(sets & ~relation.sets) for relation in some]
        diagram = reduce(or_, parts)
        small = len(some) == 1 or diagram.node_count() <= _MOST_MERGED
        return [_Relation(diagram, sets)] if small else some

    def _kept(self, mask: int) -> Diagram:
        """That some bits are after as before."""
        kept = self._manager.true()
        for bit in reversed(self._bits):
            if mask >> bit & 1:
                kept = self._before[bit].equiv(self._after[bit]) & kept
        return kept

    def _ready(self, relation: _Relation) -> _Step:
        at = {bit: 2 * place for place, bit in enumerate(self._bits) if relation.sets >> bit & 1}
        return _Step(
            relation.diagram,
            self._fixed(relation.sets, -1, self._before),
            self._fixed(relation.sets, -1, self._after),
            Diagram.make_substitution((place + 1, self._before[bit]) for bit, place in at.items()),
            Diagram.make_substitution((place, self._after[bit]) for bit, place in at.items()),
        )

    def _fixed(self, mask: int, values: int, variables: dict[int, Diagram]) -> Diagram:
        """That the bits of a mask have some values."""
        fixed = self._manager.true()
        for bit in reversed(self._bits):
            if mask >> bit & 1:
                fixed = (variables[bit] if values >> bit & 1 else ~variables[bit]) & fixed
        return fixed

    def _without(self, states: Diagram, forbidden: Iterable[tuple[int, int]]) -> Diagram:
        for field, value in forbidden:
            states &= ~self._fixed(field, value, self._before)
        return states
