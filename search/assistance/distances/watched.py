"""Ops looked up under whatever few others ask for, one thing an op."""

from collections import Counter
from collections.abc import Sequence
from operator import itemgetter

from search.packed.operators import Operator
from serendipity.model.deadline import Deadline

_RANK = itemgetter(0)


class Watched:
    """Each op under one field and value that it asks for: of these the rarest.

    Where many fields matter (a place each, say), no single field tells ops apart.

    Args:
        ops: the ops; candidates come in this order.
        fields: masks of the fields.
        deadline: asked for time.
    """

    def __init__(self, ops: Sequence[Operator], fields: Sequence[int], deadline: Deadline) -> None:
        by_lowest_bit = {field & -field: field for field in fields}
        asked = []
        count: Counter[tuple[int, int]] = Counter()
        for op in ops:
            deadline.tick()
            pairs = _asked(op, by_lowest_bit)
            asked.append(pairs)
            for pair in pairs:
                count[pair] += 1
        self._always: list[tuple[int, Operator]] = []
        under: dict[int, dict[int, list[tuple[int, Operator]]]] = {}
        for rank, (op, pairs) in enumerate(zip(ops, asked, strict=True)):
            deadline.tick()
            if pairs:
                field, value = min(pairs, key=lambda pair: count[pair])
                under.setdefault(field, {}).setdefault(value, []).append((rank, op))
            else:
                self._always.append((rank, op))
        self._under = list(under.items())

    def candidates(self, state: int) -> list[Operator]:
        """Ops that may be applicable in a packed state; all that are, among them."""
        found = self._always[:]
        for field, by_value in self._under:
            ops = by_value.get(state & field)
            if ops is not None:
                found += ops
        found.sort(key=_RANK)
        return [op for _, op in found]


def _asked(op: Operator, by_lowest_bit: dict[int, int]) -> list[tuple[int, int]]:
    pairs = []
    left = op.need_mask
    while left:
        field = by_lowest_bit[left & -left]
        pairs.append((field, op.need & field))
        left &= ~field
    return pairs
