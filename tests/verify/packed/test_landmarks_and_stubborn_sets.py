"""Landmarks weigh no more than plans, stubborn sets keep a cheapest one, against plain sets."""

import numpy as np
import pytest
from hypothesis import given

from serendipity.model import Deadline, Task, UsageError
from serendipity.testing.generator.families import family_task
from serendipity.testing.oracle import best
from serendipity.testing.strategies import Call, calls, tasks
from tests.verify.packed.test_packed_search_equals_brute_force import (
    FAMILY,
    distances,
    reached,
    team_problem,
)
from verify.base.execution import State, after, applicable
from verify.base.individual import IndividualOptimum
from verify.base.optimal_plans import OptimalPlans
from verify.calls.solve import solve
from verify.limits import limited
from verify.packed.cheapest_path import PackedSearch
from verify.packed.landmark_cuts import LandmarkCuts
from verify.packed.operators import Ints, PackedOperator
from verify.packed.pattern import FAR
from verify.packed.stubborn import StubbornSets


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


def cheapest_kept(task: Task) -> None:
    """From every state some operator of the stubborn set starts a cheapest plan."""
    states = reached(task)
    expected = distances(task, states)
    done = operators(task)
    sets = StubbornSets(done, frozenset(range(len(task.facts))), task.goal.positive)
    for state in states[:300]:
        ready = [i for i, action in enumerate(task.actions) if applicable(action, state)]
        few = sets(state, ready)
        assert set(few) <= set(ready)
        if expected.get(state, 0) > 0:
            results = ((done[i].weight, after(state, task.actions[i])) for i in few)
            assert min(w + expected.get(new, FAR) for w, new in results) == expected[state]


@given(tasks())
def test_stubborn_sets_in_random_tasks(task: Task) -> None:
    cheapest_kept(task)


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_stubborn_sets_in_families(name: str, seed: int, size: int) -> None:
    cheapest_kept(family_task(name, seed, size))


def test_of_independent_operators_one_is_enough() -> None:
    done = [PackedOperator((), (), (k,), (), 1) for k in range(6)]
    sets = StubbornSets(done, frozenset(range(6)), range(6))
    assert len(sets(frozenset({2}), [0, 1, 3, 4, 5])) == 1


def test_what_takes_away_a_need_is_looked_at_beside_it() -> None:
    """To walk away first is no way to take what is here."""
    take, walk, wait = (
        PackedOperator((0,), (), (1,), (), 1),
        PackedOperator((0,), (), (2,), (0,), 1),
        PackedOperator((), (), (3,), (), 1),
    )
    sets = StubbornSets([take, walk, wait], frozenset(range(4)), [1, 2, 3])
    assert set(sets(frozenset({0, 3}), [0, 1, 2])) == {0, 1}


def zero(states: np.ndarray) -> Ints:
    return np.zeros(len(states), np.int64)


def searched(task: Task, state: State, below: int, *, stubborn: bool) -> int | None:
    """The least weight as a search with landmarks finds it."""
    problem = team_problem(task)
    start = problem.pack([state])
    assert start is not None
    asked = problem.table.operators, frozenset(range(len(task.facts))), task.goal.positive
    cuts = [LandmarkCuts(*asked, rarest=rarest) for rarest in (True, False)]
    sets = StubbornSets(*asked) if stubborn else None
    search = PackedSearch(problem.table, problem.goal, zero, Deadline(), below, 10**6, cuts, sets)
    search.add(start, np.zeros(1, np.int64))
    found = search.run()
    return None if found is None else search.paid(found)


def searches_agree(task: Task) -> None:
    states = reached(task)
    expected = distances(task, states)
    for state in states[:: max(1, len(states) // 5)]:
        for stubborn in (True, False):
            assert searched(task, state, 2**60, stubborn=stubborn) == expected.get(state)
            if state in expected:
                assert searched(task, state, expected[state], stubborn=stubborn) is None
                assert searched(task, state, expected[state] + 1, stubborn=stubborn) == expected[state]


@given(tasks())
def test_searches_in_random_tasks(task: Task) -> None:
    searches_agree(task)


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_searches_in_families(name: str, seed: int, size: int) -> None:
    searches_agree(family_task(name, seed, size))


def test_whole_answers_with_landmarks() -> None:
    """Programs decide nothing here, and landmarks are looked for as soon as there are two states."""
    decided = 0

    @given(calls(modes=("serendipity", "communication", "composite")))
    def law(call: Call) -> None:
        nonlocal decided
        try:
            optimum = best(call.task, call.options, call.human_plan)
        except UsageError:
            return
        with limited(few_states=1, few_joint_states=0, methods=("-programs",)):
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
