"""An index of operators: each stands under the one of its conditions that the fewest others share."""

from collections import Counter
from collections.abc import Sequence
from operator import itemgetter

from search.packed.operator_index import LiteralIndex
from search.packed.operators import Operator, split
from serendipity.model.resources.deadline import Deadline

_RANK = itemgetter(0)


class Watched:
    """Each op under one field and value that it asks for: of these the rarest.

    Where many fields matter (a place each, say), no single field tells ops apart.

    Args:
        ops: the ops; candidates come in this order.
        fields: masks of the fields.
        deadline: polled while they are sorted in.
    """

    def __init__(self, ops: Sequence[Operator], fields: Sequence[int], deadline: Deadline) -> None:
        by_lowest_bit = {field & -field: field for field in fields}
        asked = []
        count: Counter[tuple[int, int]] = Counter()
        for op in ops:
            deadline.tick()
            pairs = [(field, op.need & field) for field in split(op.need_mask, by_lowest_bit)]
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
