"""Values that other robots provide: how soon, and what they pay for them at least.

The soonest is told as if nothing that was true ever ceased to be.  What they pay is told of *leaves*: fields
on which nothing else of theirs depends.  Whoever was the last robot to set such a field is told of all that
robots do to it: others can leave their part out and still do everything else.  Between two moments at which
the robot knows the value (it, or the human's plan, has set it; or it has asked for it, and set it then) only
others change it, so what they pay for that adds up.
"""

from collections.abc import Callable, Sequence

import numpy as np

from search.engine.shortest_paths import backward
from search.packed.cost_vector import FAR
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from search.short_windows.independent.rows import Amounts
from serendipity.model.resources.deadline import Deadline

Value = tuple[int, int]
"""A field and its value, in place."""

Provision = dict[Value, int]
"""After how many epochs a value can have been set."""


def provisions(packed: PackedTask, steps: Sequence[Operator], deadline: Deadline) -> dict[int, Provision]:
    """By robot what it can set and after how many epochs, while the human follows their plan.

    Args:
        packed: the packed task; each action without the human has one participant.
        steps: the human's plan, an action an epoch.
    """
    changes = []
    for op in deadline.each(packed.others):
        needs = frozenset(packed.assigned(op.need_mask, op.need))
        changes.append((op.agents, needs, [*packed.assigned(packed.all_ones & ~op.keep, op.put)]))
    found: dict[int, Provision] = {}
    state = packed.init
    known = set(packed.assigned(packed.all_ones, state))
    for epoch, step in enumerate(steps, start=1):
        new: set[Value] = set()
        left = []
        for robot, needs, sets in deadline.each(changes):
            if needs <= known:
                provision = found.setdefault(robot, {})
                for value in sets:
                    provision.setdefault(value, epoch)
                new.update(sets)
            else:
                left.append((robot, needs, sets))
        changes = left
        state = state & step.keep | step.put
        known.update(new, packed.assigned(packed.all_ones, state))
    return found


def by_others(found: dict[int, Provision], robot: int) -> Provision:
    """The same, by robot, for what all robots but one can set."""
    soonest: Provision = {}
    for other, provision in found.items():
        if other != robot:
            for value, epoch in provision.items():
                soonest[value] = min(epoch, soonest.get(value, epoch))
    return soonest


def leaves(packed: PackedTask) -> list[int]:
    """Fields on which nothing else depends: robots' operators that mention one set nothing else."""
    found = set(packed.fields)
    for op in packed.others:
        sets = packed.all_ones & ~op.keep
        found -= {field for field in found if field & packed.mentioned(op) and sets & ~field}
    return [field for field in packed.fields if field in found]


def detours(
    packed: PackedTask, field: int, robot: int, amount: Callable[[Operator], int], deadline: Deadline
) -> Amounts:
    """Least costs for other robots to bring a field from one value to another, by both; ``FAR``: no way.

    Args:
        field: one that others ask for only where they set nothing else.
        robot: the one that pays nothing.
        amount: of an operator.
    """
    steps: dict[int, list[tuple[int, int]]] = {}
    for op in packed.others:
        if op.agents != robot and field & ~op.keep:
            asked = [op.need & field] if op.need_mask & field else packed.values(field)
            steps.setdefault(op.put & field, []).extend((amount(op), before) for before in asked)
    shift, size = (field & -field).bit_length() - 1, 1 << field.bit_count()
    found = np.full((size, size), FAR, dtype=np.int64)
    for end in packed.values(field):
        for value, paid in backward([(0, end)], [steps], deadline).items():
            found[value >> shift, end >> shift] = min(paid, FAR)
    return found
