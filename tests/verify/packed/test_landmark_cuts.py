"""Landmarks of a state weigh no more than plans from it, against plain sets."""

import pytest
from hypothesis import given

from serendipity.model import Task, UsageError
from serendipity.testing.generator.families import family_task
from serendipity.testing.oracle import best
from serendipity.testing.strategies import Call, calls, tasks
from tests.verify.packed.test_packed_search_equals_brute_force import (
    FAMILY,
    distances,
    reached,
)
from verify.base.execution import after, applicable
from verify.base.individual import IndividualOptimum
from verify.base.optimal_plans import OptimalPlans
from verify.calls.solve import solve
from verify.limits import limited
from verify.packed.landmark_cuts import LandmarkCuts
from verify.packed.operators import FAR, PackedOperator


def operators(task: Task) -> list[PackedOperator]:
    return [PackedOperator(a.pre, a.neg, a.add, a.delete, int(a.cost * 1000) + 1) for a in task.actions]


def sound(task: Task, *, rarest: bool) -> None:
    """In every state, and after every operator, landmarks weigh no more than a cheapest plan."""
    states = reached(task)
    expected = distances(task, states)
    done = operators(task)
    cuts = LandmarkCuts(done, frozenset(range(len(task.facts))), task.goal.positive, rarest=rarest)
    for state in states[:300]:
        found = cuts(state)
        assert found.bound <= expected.get(state, FAR)
        shares = dict(zip(found.operators.tolist(), found.shares.tolist(), strict=True))
        assert all(0 < share <= done[i].weight for i, share in shares.items())
        if found.bound < FAR:
            for i, action in enumerate(task.actions):
                if applicable(action, state):
                    left = expected.get(after(state, action), FAR)
                    assert found.bound - shares.get(i, 0) <= left


@pytest.mark.parametrize("rarest", [True, False])
def test_landmarks_in_random_tasks(rarest: bool) -> None:
    @given(tasks())
    def law(task: Task) -> None:
        sound(task, rarest=rarest)

    law()


@pytest.mark.parametrize("rarest", [True, False])
@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_landmarks_in_families(name: str, seed: int, size: int, rarest: bool) -> None:
    sound(family_task(name, seed, size), rarest=rarest)


def test_landmarks_say_much() -> None:
    """Most of what it costs to carry parcels about."""
    task = family_task("logistics", 1, 2)
    cuts = LandmarkCuts(operators(task), frozenset(range(len(task.facts))), task.goal.positive, rarest=True)
    assert cuts(task.init).bound > 0.7 * distances(task, reached(task))[task.init] > 0


def test_whole_answers_with_better_bounds() -> None:
    """Programs decide nothing here, and better bounds are made as soon as there are two states."""
    decided = 0

    @given(calls(modes=("serendipity", "communication", "composite")))
    def law(call: Call) -> None:
        nonlocal decided
        try:
            optimum = best(call.task, call.options, call.human_plan)
        except UsageError:
            return
        with limited(few_states=1, methods=("-programs",)):
            result = solve(call.task, call.options, human_plan=call.human_plan_names, method="auto")
        assert result.status in (optimum.status, "unknown")
        if result.status == "optimal" and call.options.ties == "fixed":
            assert result.objective == float(optimum.objective or 0)
            decided += 1

    law()
    assert decided


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_a_plan_that_is_supposed_to_be_optimal(name: str, seed: int, size: int) -> None:
    """It is believed only if nothing is cheaper."""
    task = family_task(name, seed, size)
    plan = OptimalPlans(task).canonical()
    if not plan:
        return
    expected = IndividualOptimum(task).optimum(task.init)
    supposed = IndividualOptimum(task)
    supposed.suppose(plan)
    assert supposed.optimum(task.init) == expected
    for there in task.human_actions:
        state = after(task.init, task.actions[there])
        for back in task.human_actions:
            both = applicable(task.actions[there], task.init) and applicable(task.actions[back], state)
            if both and after(state, task.actions[back]) == task.init:
                dearer = IndividualOptimum(task)
                dearer.suppose((there, back, *plan))
                assert dearer.optimum(task.init) == expected
                return
