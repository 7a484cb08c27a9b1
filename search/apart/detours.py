"""What others pay before a robot can ask them for a value of a field on which nothing else of theirs depends.

Whoever was the last robot to set such a field is told of all that robots do to it: others can leave their
part out and still do everything else.  Between two moments at which the robot knows the value (it, or the
human's plan, has set it; or it has asked for it, and set it then) only others change it, so what they pay
for that adds up.
"""

from collections.abc import Callable
from heapq import heappop, heappush

import numpy as np

from search.short_windows.independent.rows import Amounts
from search.packed.cost_vector import FAR
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask


def leaves(packed: PackedTask) -> list[int]:
    """Fields of which this is so: robots' operators that ask for one, or set it, set nothing else."""
    found = set(packed.fields)
    for op in packed.others:
        sets = packed.all_ones & ~op.keep
        found -= {field for field in found if field & packed.mentioned(op) and sets & ~field}
    return [field for field in packed.fields if field in found]


def detours(packed: PackedTask, field: int, robot: int, amount: Callable[[Operator], int]) -> Amounts:
    """What other robots pay at least to bring a field from one value to another, by both; ``FAR``: no way.

    Args:
        packed: the packed task.
        field: one that others ask for only where they set nothing else.
        robot: the one that pays nothing.
        amount: of an operator.
    """
    steps = [
        (op.need & field if op.need_mask & field else None, op.put & field, amount(op))
        for op in packed.others
        if op.agents != robot and field & ~op.keep
    ]
    shift, size = (field & -field).bit_length() - 1, 1 << field.bit_count()
    found = np.full((size, size), FAR, dtype=np.int64)
    for end in packed.values(field):
        queue, known = [(0, end)], set[int]()
        while queue:
            paid, value = heappop(queue)
            if value in known:
                continue
            known.add(value)
            found[value >> shift, end >> shift] = min(paid, FAR)
            for asked, put, price in steps:
                if put == value:
                    for before in packed.values(field) if asked is None else (asked,):
                        if before not in known:
                            heappush(queue, (paid + price, before))
    return found
