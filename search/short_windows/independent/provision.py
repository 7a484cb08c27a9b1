"""When robots can have set a value at the soonest, if nothing that was true ever ceases to be."""

from collections.abc import Sequence
from typing import NamedTuple

from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline

Value = tuple[int, int]
"""A field and its value, in place."""

Provision = dict[Value, int]
"""After how many epochs a value can have been set."""


class _Change(NamedTuple):
    op: Operator
    needs: frozenset[Value]
    sets: list[Value]


def provisions(
    packed: PackedTask, steps: Sequence[Operator], epochs: int, deadline: Deadline
) -> dict[int, Provision]:
    """By robot what it can set and after how many epochs, while the human follows their plan.

    Args:
        packed: the packed task; each action without the human has one participant.
        steps: the human's plan, an action an epoch.
        epochs: how many are looked at.
        deadline: polled.
    """
    changes = []
    for op in packed.others:
        deadline.tick()
        needs = frozenset(packed.assigned(op.need_mask, op.need))
        sets = list(packed.assigned(packed.all_ones & ~op.keep, op.put))
        changes.append(_Change(op, needs, sets))
    found: dict[int, Provision] = {}
    state = packed.init
    known = set(packed.assigned(packed.all_ones, state))
    for epoch in range(1, epochs + 1):
        new: set[Value] = set()
        left = []
        for change in changes:
            deadline.tick()
            if change.needs <= known:
                provision = found.setdefault(change.op.agents, {})
                for value in change.sets:
                    provision.setdefault(value, epoch)
                new.update(change.sets)
            else:
                left.append(change)
        changes = left
        if epoch <= len(steps):
            state = state & steps[epoch - 1].keep | steps[epoch - 1].put
            new.update(packed.assigned(packed.all_ones, state))
        known |= new
    return found


def by_others(found: dict[int, Provision], robot: int) -> Provision:
    """The same for what robots but one can set.

    Args:
        found: by robot what it can set.
        robot: the one that is left out.
    """
    soonest: Provision = {}
    for other, provision in found.items():
        if other != robot:
            for value, epoch in provision.items():
                soonest[value] = min(epoch, soonest.get(value, epoch))
    return soonest
