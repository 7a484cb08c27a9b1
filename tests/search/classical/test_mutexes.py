"""Pairs of values that are never reached together."""

from random import Random

import pytest

from search.classical.mutexes import ReachablePairs
from search.packed.operators import Operator, applicable
from serendipity.model.resources.deadline import Deadline
from tests.search.small_tasks import of_a_family, packed_of, reached


def _may_hold(pairs: ReachablePairs, mask: int, state: int) -> bool:
    """Whether what fields hold in a state may be true at once: an operator that asks for it beside itself."""
    asking = Operator(mask, state & mask, -1, 0, (), 0, 0, 0)
    return pairs.may_share_a_state(asking, asking)


@pytest.mark.parametrize("seed", range(12))
def test_what_can_happen_in_a_state_is_not_excluded(seed: int) -> None:
    dice = Random(seed)
    packed = packed_of(of_a_family(dice))
    pairs, operators = ReachablePairs(packed, Deadline()), (*packed.own, *packed.joint, *packed.others)
    found = reached(packed, operators, most=3_000)
    for state in dice.sample(found, min(60, len(found))):
        able = [op for op in (*packed.own, *packed.others) if applicable(op, state)]
        assert _may_hold(pairs, packed.all_ones, state)
        assert all(pairs.may_share_a_state(a, b) for a in able for b in able)
