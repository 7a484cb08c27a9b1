"""The human alone, beside no script: each action as one step, which is no other answer than brute force's."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from search.human.whole_actions import alone_planner
from search.kernel.library import library
from search.packed.cost_vector import INFINITE_KEY, own_weights
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from serendipity.model import Deadline, Task, UsageError
from serendipity.model.task.unit_steps import unit_steps
from serendipity.model.task.whole_actions import whole_actions
from serendipity_testing.oracle import optimal_human_plan
from serendipity_testing.strategies.time import timed_tasks


@given(timed_tasks(), st.integers(0, 2), st.sampled_from((0, 1, 2)))
def test_the_canonical_plan_of_whole_actions_is_that_of_brute_force(
    task: Task, wait: int, price: int
) -> None:
    if price:
        costly = [replace(action, cost=Fraction(price * action.duration)) for action in task.actions]
        task = replace(task, actions=tuple(costly))
    assume(task.needs_time and whole_actions(task) is not None)
    plan = optimal_human_plan(task)
    try:
        found = serendipity.plan(task, mode="individual", head_start=wait)
    except UsageError:
        assert plan == ()
        assert task.robot_goal
        return
    assert found.human_plan == (None if plan is None else tuple(task.actions[i].name for i in plan))
    if plan is not None:
        assert found.horizon == task.epochs_of(plan) + wait
        assert [step.epoch - wait for step in found.plan or ()] == [*task.starts_of(plan)]


@pytest.mark.skipif(library() is None, reason="the kernel is not compiled here")
@given(timed_tasks(), st.integers(1, 40))
def test_the_kernel_finds_the_canonical_plan_and_what_is_left_in_whole_actions(task: Task, most: int) -> None:
    """Also from states in the middle of an action, with which the human may not be able to go on."""
    assume(task.needs_time)
    units = unit_steps(task)
    packed = PackedTask(units.task, frozenset(), Deadline())
    alone = alone_planner(packed, packed.goal, Deadline())
    assume(alone is not None)
    plan = optimal_human_plan(task)
    assert alone.canonical(packed.init, Deadline()) == (None if plan is None else units.plan(plan))
    cheapest, bound = (lambda state, ask=ask: ask(state, Deadline()) for ask in (alone.cheapest, alone.bound))
    weights, seen = own_weights(packed), [packed.init]
    for state in seen:
        going_on = {op.action for field, value, op in packed.due if state & field == value}
        possible = [op for op in packed.own if applicable(op, state)]
        if any(op.agents == packed.human_bit for field, value, op in packed.due if state & field == value):
            possible = [op for op in possible if op.action in going_on]
        after = [(state & op.keep | op.put, weights[op.cost]) for op in possible]
        seen += [one for one in dict(after) if one not in seen][: most - len(seen)]
        rest = min((cheapest(one) + weight for one, weight in after), default=INFINITE_KEY)
        expected = 0 if packed.goal.holds(state) else min(rest, INFINITE_KEY)
        assert bound(state) <= cheapest(state) == expected
