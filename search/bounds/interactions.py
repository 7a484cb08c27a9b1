"""Interactions of the human with others: their touches, and what each of them needs.

Fields fall apart into the human's *private* ones (no op changes them without
them), and *outside* ones, which robots change.  A *touch* is an op of theirs that
mentions an outside field, or a joint one.  Between touches they are alone in
their private fields, and nothing outside changes but by robots.  A *need* is the
outside part of the condition of a touch.
"""

from itertools import chain
from typing import NamedTuple

from search.packed.operator_index import OperatorIndex
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask


class Need(NamedTuple):
    """Outside fields that a touch asks for, and their values."""

    mask: int
    value: int


class Seen(NamedTuple):
    """An op of the human's in the projection onto their private fields."""

    need_mask: int
    need: int
    keep: int
    put: int
    cost: int
    """Index of its cost."""
    interaction: int
    """Id of its need; -1 if it is no touch."""


class Interactions:
    """The human's ops, split at what they mention.

    Args:
        mask: the private fields that the projection of :func:`.whole_graph` or :func:`.partial_graph` keeps.

    Attributes:
        outside: the fields that some op without them changes.
        needs: the needs met so far; a need's id is its index.
    """

    def __init__(self, packed: PackedTask, mask: int) -> None:
        self.mask = mask
        self.needs: list[Need] = []
        self._ids: dict[Need, int] = {}
        self._kinds: dict[tuple[int, int, int, object], tuple[int, int, bool]] = {}
        self._packed = packed
        self.outside = packed.outside
        self._indices: list[tuple[OperatorIndex[Operator], dict[int, list[Seen]]]]
        self._indices = [(packed.own_index, {}), (packed.joint_index, {})]

    def seen(self, state: int) -> list[Seen]:
        """Moves and touches that are possible in a projected state."""
        found = []
        for index, known in self._indices:
            value = state & index.field
            ops = known.get(value)
            if ops is None:
                ops = known[value] = self._look(index, value)
            found += [op for op in ops if state & op.need_mask == op.need]
        return found

    def is_interaction(self, action: int) -> bool:
        """Whether an action of the human's is a touch."""
        op = self._packed.op(action)
        return self._packed.involves_others(op.agents, self._packed.mentioned(op))

    def _look(self, index: OperatorIndex[Operator], value: int) -> list[Seen]:
        """The ops under a value of an index; under every value, if the field is not the human's own."""
        hidden = index.field & ~self.mask
        groups = index.by_value.values() if hidden else [index.by_value.get(value, ())]
        return [self._project(op) for op in chain(*groups, index.always)]

    def _project(self, op: Operator) -> Seen:
        form = op.need_mask, op.keep, op.agents, op.forbidden
        kind = self._kinds.get(form)
        if kind is None:
            interaction = self._packed.involves_others(op.agents, self._packed.mentioned(op))
            kind = self._kinds[form] = op.need_mask & self.mask, op.need_mask & self.outside, interaction
        need_mask, asked, interaction = kind
        mask, number = self.mask, -1
        if interaction:
            need = Need(asked, op.need & self.outside)
            number = self._ids.setdefault(need, len(self.needs))
            if number == len(self.needs):
                self.needs.append(need)
        return Seen(need_mask, op.need & mask, op.keep, op.put & mask, op.cost, number)
