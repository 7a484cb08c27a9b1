"""Symbolic search finds the costs of brute force, and the plan that enumeration puts first."""

from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from search.classical.problem import INFINITE_WEIGHT
from search.classical.symbolic import cheapest_plan
from search.kernel.library import library
from serendipity import Task
from serendipity.model import Deadline, LimitReachedError
from serendipity_testing.generator.families import FAMILIES, family_task
from serendipity_testing.strategies import tasks
from tests.search.classical.exact_costs import exact
from tests.search.classical.test_canonical_plans import first_of_all
from tests.search.classical.test_kernel_equals_brute_force import planner_of
from tests.search.small_tasks import CORRIDOR, packed_of

pytest.importorskip("oxidd", reason="it needs the extra `symbolic`")
pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")


@given(tasks(), st.integers(0, 2**32))
def test_costs_and_plans_are_those_of_enumeration(task: Task, seed: int) -> None:
    from search.classical.symbolic.bidirectional import Bidirectional

    packed = packed_of(task)
    planner, costs, random = planner_of(packed), exact(packed), Random(seed)
    problem = planner.problem
    for state in (packed.init, random.choice([*costs])):
        cost = costs[state]
        above = min(problem.limit(cost) + 1, INFINITE_WEIGHT)
        limit = random.choice([INFINITE_WEIGHT, problem.limit(cost), above])
        search = Bidirectional(problem, state & problem.mask, limit)
        bounds = [*search.bounds()]
        assert bounds == sorted(bounds)
        assert bounds[-1] == search.best == min(problem.limit(cost), limit)
        if search.best < limit and state == packed.init:
            assert search.plan() == first_of_all(packed, planner, costs)


def test_a_process_of_its_own_tells_bounds_and_a_plan() -> None:
    packed = packed_of(CORRIDOR)
    planner, costs = planner_of(packed), exact(packed)
    start, bounds = packed.init & planner.problem.mask, list[int]()
    plan = cheapest_plan(planner.problem, start, INFINITE_WEIGHT, Deadline(), bounds.append)
    assert plan == first_of_all(packed, planner, costs)
    assert planner.problem.amount(bounds[-1]) == costs[packed.init]
    assert bounds == sorted(bounds)
    assert cheapest_plan(planner.problem, start, bounds[-1], Deadline(), bounds.append) is None


def test_it_keeps_limits_and_gives_up() -> None:
    problem = planner_of(packed_of(CORRIDOR)).problem
    with pytest.raises(LimitReachedError):
        cheapest_plan(problem, 0, INFINITE_WEIGHT, Deadline(0), lambda _: None)
    with pytest.raises(MemoryError):
        cheapest_plan(None, 0, INFINITE_WEIGHT, Deadline(), lambda _: None)  # type: ignore[arg-type]


@pytest.mark.long
def test_answers_are_the_same_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel hands over at once."""
    calls = ({"mode": "individual"}, {"mode": "composite", "horizon": "inf", "discount": "0.9"})
    asked = list[int | None]()

    def spied(*args: Any) -> list[int] | None:
        plan = cheapest_plan(*args)
        asked.append(None if plan is None else len(plan))
        return plan

    for family in FAMILIES:
        for call in calls:
            task = family_task(family, 5, 3)
            expected = serendipity.plan(task, **call)
            with monkeypatch.context() as patched:
                patched.setattr("search.classical.planner._MUCH_WORK", 0)
                patched.setattr("search.classical.planner.SLICE", 1e-6)
                patched.setattr("search.classical.symbolic.cheapest_plan", spied)
                found = serendipity.plan(task.at(task.init), **call)
            assert (found.status, found.cost) == (expected.status, expected.cost)
            if call["mode"] == "individual":  # where the plan is the canonical one
                assert found.plan == expected.plan
    assert sum(plan is not None for plan in asked) > 3
