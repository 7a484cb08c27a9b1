"""Landmarks of one state bound what the human pays from others."""

from heapq import heappop, heappush
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from search.packed.cost_vector import FAR
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from search.short_windows.independent.landmarks import Landmarks, left_to_pay
from search.short_windows.independent.provision import Value
from search.short_windows.independent.rows import codes, column
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.builders import task as build
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


def _errands(count: int) -> PackedTask:
    actions = {f"do_{i} h": f"-> done_{i} @ 1" for i in range(count)}
    helps = {f"help_{i} r": f"-> done_{i} @ 1" for i in range(count)}
    goal = " ".join(f"done_{i}" for i in range(count))
    return packed_of(build(goal=goal, actions=actions | helps))


@pytest.mark.parametrize("count", [1, 7, 8, 9, 70])
def test_every_errand_is_a_landmark(count: int) -> None:
    packed = _errands(count)
    every = _every_value(packed)
    assert _bound(packed, packed.init, packed.init, every) == count
    helped = packed.init & ~packed.fields[0] | packed.goal.need & packed.fields[0]
    assert _bound(packed, packed.init, helped, every) == count - 1
    assert _bound(packed, helped, packed.init, every) == count - 1


def test_what_only_a_gift_can_bring() -> None:
    """There is no way without it, and with it there may be one."""
    actions = {"first h": "gift -> half @ 1", "second h": "half -> end @ 1", "bring r": "-> gift @ 1"}
    packed = packed_of(build(goal="end", actions=actions))
    given = packed.init
    for op in packed.others:
        given = given & op.keep | op.put
    every = _every_value(packed)
    assert _bound(packed, packed.init, packed.init, every) == FAR
    assert _bound(packed, packed.init, given, every) <= 2
    assert _bound(packed, given, given, every) == 2


def test_a_field_across_two_words() -> None:
    field = 0b111 << 62
    rows = np.concatenate([column(code << 62, 2) for code in range(8)], axis=1)
    assert codes(rows, field).tolist() == list(range(8))
