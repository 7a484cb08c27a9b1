"""The human alone, beside no script: each action as one step, which is no other answer than brute force's."""

from dataclasses import replace
from fractions import Fraction

from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Task, UsageError
from serendipity.model.task.whole_actions import whole_actions
from serendipity.testing.oracle import optimal_human_plan
from serendipity.testing.strategies.time import timed_tasks


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
