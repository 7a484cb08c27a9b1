"""What the human can reach alone if nothing that became true ever becomes false again."""

from collections.abc import Sequence

from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal
from serendipity.model.resources.deadline import Deadline


def may_reach(
    state: int, goal: PackedGoal, fields: Sequence[int], operators: Sequence[Operator], deadline: Deadline
) -> bool:
    """Whether the delete relaxation has a way from a packed state to a goal; no way there, none at all.

    Args:
        state: where it starts.
        goal: what has to hold.
        fields: masks of the fields.
        operators: what may be done.
        deadline: polled at each operator.
    """
    values = {field: {state & field} for field in fields}

    def met(mask: int, need: int) -> bool:
        return all(need & field in known for field, known in values.items() if field & mask)

    waiting = list(operators)
    while not met(goal.need_mask, goal.need):
        later = []
        for op in waiting:
            deadline.tick()
            if not met(op.need_mask, op.need):
                later.append(op)
                continue
            for field, known in values.items():
                if field & ~op.keep:
                    known.add(op.put & field)
        if len(later) == len(waiting):
            return False
        waiting = later
    return True
