"""Pairs of values that are never reached together."""

from random import Random

import pytest

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.classical.mutexes import ReachablePairs
from search.packed.operators import Operator, applicable
from search.packed.packed_task import PackedTask
from serendipity.model import Options, Task
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.builders import task as build
from serendipity.testing.generator.families import AGENTS, FAMILIES, SMALL

_MOST = 3_000


def _packed(task: Task) -> PackedTask:
    return SearchContext(PreparedTask(task), Options(), Deadline()).packed


def _reached(packed: PackedTask) -> list[int]:
    """Packed states that agents reach one action after another, in breadth-first order."""
    found = [packed.init]
    seen = {packed.init}
    for state in found:
        for op in (*packed.own, *packed.joint, *packed.others):
            if applicable(op, state) and (after := state & op.keep | op.put) not in seen:
                seen.add(after)
                found.append(after)
        if len(found) > _MOST:
            break
    return found


def _may_hold(pairs: ReachablePairs, mask: int, state: int) -> bool:
    """Whether what fields hold in a state may be true at once: an operator that asks for it beside itself."""
    asking = Operator(mask, state & mask, -1, 0, (), 0, 0, 0)
    return pairs.may_share_a_state(asking, asking)


@pytest.mark.parametrize("seed", range(12))
def test_what_can_happen_in_a_state_is_not_excluded(seed: int) -> None:
    dice = Random(seed)
    family = dice.choice(sorted(FAMILIES))
    size, agents = dice.choice(SMALL[family])
    packed = _packed(FAMILIES[family](dice, size, AGENTS[:agents]))
    pairs = ReachablePairs(packed, Deadline())
    for state in dice.sample(reached := _reached(packed), min(60, len(reached))):
        able = [op for op in (*packed.own, *packed.others) if applicable(op, state)]
        assert _may_hold(pairs, packed.all_ones, state)
        assert all(pairs.may_share_a_state(a, b) for a in able for b in able)


def test_a_lamp_is_not_left_on_behind_a_closed_door() -> None:
    task = build(
        goal="seen sealed burnt",
        actions={
            "open h": "!open -> open",
            "light h": "open -> lamp",
            "see h": "lamp -> seen",
            "quench h": "lamp -> !lamp",
            "close h": "open !lamp -> !open",
            "seal h": "!open -> sealed",
            "burn h": "lamp !open -> burnt",
        },
    )
    packed = _packed(task)
    pairs = ReachablePairs(packed, Deadline())
    door, lamp = (packed.fact_bits[task.facts.index(fact)] for fact in ("open", "lamp"))
    assert door is not None
    assert lamp is not None
    both = door[0] | lamp[0]
    held = {state: _may_hold(pairs, both, state) for state in (0, door[1], lamp[1], door[1] | lamp[1])}
    assert not _may_hold(pairs, packed.goal.need_mask, packed.goal.need), "it can't burn"
    assert held == {0: True, door[1]: True, lamp[1]: False, door[1] | lamp[1]: True}
