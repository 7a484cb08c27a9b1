"""Landmarks of one state bound what the human pays from others."""

from heapq import heappop, heappush
from random import Random

from hypothesis import given
from hypothesis import strategies as st

from search.packed.cost_vector import FAR
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from search.short_windows.independent.landmarks import Landmarks, left_to_pay
from search.short_windows.independent.provision import Value
from search.short_windows.independent.rows import column
from serendipity.model.resources.deadline import Deadline
from tests.search.small_tasks import of_a_family, packed_of


def _cost(packed: PackedTask, state: int) -> int:
    """What the human pays alone, with one for each operator more than its place among the costs."""
    queue, known = [(0, state)], set[int]()
    while queue:
        spent, state = heappop(queue)
        if packed.goal.holds(state):
            return spent
        if state not in known:
            known.add(state)
            for op in packed.own:
                if applicable(op, state):
                    heappush(queue, (spent + op.cost + 1, state & op.keep | op.put))
    return FAR


def _random_state(packed: PackedTask, dice: Random) -> int:
    return sum(dice.choice(list(packed.values(field))) for field in packed.fields)


def _every_value(packed: PackedTask) -> set[Value]:
    return {(field, value) for field in packed.fields for value in packed.values(field)}


def _bound(packed: PackedTask, of: int, at: int, given: set[Value]) -> int:
    found = Landmarks(packed, lambda op: op.cost + 1, Deadline()).of(of, given)
    words = max(1, -(-packed.all_ones.bit_length() // 64))
    return int(left_to_pay(found, column(at, words))[0])


@given(st.integers(0, 10**6))
def test_no_bound_is_above_the_cost(seed: int) -> None:
    """Of any state, by landmarks of any other one."""
    dice = Random(seed)
    packed = packed_of(of_a_family(dice))
    of, at = _random_state(packed, dice), _random_state(packed, dice)
    assert _bound(packed, of, at, _every_value(packed)) <= _cost(packed, at)
    assert _bound(packed, at, at, set()) <= _cost(packed, at)
