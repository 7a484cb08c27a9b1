"""Dead-end values of the human's goal."""

from search.packed.packed_task import PackedTask


def lost_values(packed: PackedTask) -> dict[int, set[int]]:
    """By field of the human's goal the values from which they alone never get to what it asks for."""
    lost = {}
    for field in packed.fields:
        if packed.goal.need_mask & field:
            moves = [op for op in packed.own if field & ~op.keep]
            good, known = {packed.goal.need & field}, 0
            while len(good) > known:
                known = len(good)
                for op in moves:
                    if op.put & field in good:
                        good.update([op.need & field] if op.need_mask & field else packed.values(field))
            lost[field] = set(packed.values(field)) - good
    return lost
