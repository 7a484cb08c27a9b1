"""An index of operators: each stands under the one of its conditions that the fewest others share."""

from collections import Counter
from collections.abc import Sequence
from operator import itemgetter

from search.packed.operator_index import LiteralIndex
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline

_RANK = itemgetter(0)


class Watched:
    """Each op under one field and value that it asks for: of these the rarest.

    Where many fields matter (a place each, say), no single field tells ops apart.

    Args:
        ops: the ops; candidates come in this order.
        deadline: polled while they are sorted in.
    """

    def __init__(self, packed: PackedTask, ops: Sequence[Operator], deadline: Deadline) -> None:
        asked = []
        count: Counter[tuple[int, int]] = Counter()
        for op in ops:
            deadline.tick()
            pairs = list(packed.assigned(op.need_mask, op.need))
            asked.append(pairs)
            for pair in pairs:
                count[pair] += 1
        self._index: LiteralIndex[tuple[int, Operator]] = LiteralIndex()
        for rank, (op, pairs) in enumerate(zip(ops, asked, strict=True)):
            deadline.tick()
            field, value = min(pairs, key=lambda pair: count[pair], default=(0, 0))
            self._index.add(field, value, (rank, op))

    def candidates(self, state: int) -> list[Operator]:
        """Ops that may be applicable in a packed state; all that are, among them."""
        found = self._index.candidates(state)
        found.sort(key=_RANK)
        return [op for _, op in found]
