"""Of all cheapest plans the kernel finds the one that enumeration puts first, and keeps those on its way."""

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from search.classical.canonical import canonical_plan, in_order
from search.classical.planner import ClassicalPlanner
from search.kernel.library import library
from search.packed.cost_vector import INFINITE_KEY
from search.packed.packed_task import PackedTask
from serendipity import Task
from serendipity.model import Deadline, LimitReachedError
from serendipity_testing.builders import task
from serendipity_testing.countdown import Countdown
from serendipity_testing.strategies import tasks
from tests.search.classical.exact_costs import exact
from tests.search.classical.test_kernel_equals_brute_force import assert_leads_to_goal, planner_of
from tests.search.small_tasks import CORRIDOR, packed_of

pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")


def first_of_all(packed: PackedTask, planner: ClassicalPlanner, costs: dict[int, int]) -> list[int] | None:
    """The smallest operators along which brute-force costs add up."""
    state, plan = packed.init, []
    if costs[state] == INFINITE_KEY:
        return None
    while costs[state]:
        for number in planner.allowed(state):
            op = packed.own[number]
            after = state & op.keep | op.put
            if costs[after] + planner.amount([number]) == costs[state]:
                break
        plan.append(number)
        state = after
    return plan


@given(tasks(), st.integers(0, 2**32))
def test_the_canonical_plan_is_the_first(task: Task, seed: int) -> None:
    packed = packed_of(task)
    planner, costs, random = planner_of(packed), exact(packed), Random(seed)
    expected = first_of_all(packed, planner, costs)
    assert canonical_plan(planner, packed.init, Deadline()) == expected
    for _ in range(5):  # whatever else has been asked
        planner.cheapest(random.choice([*costs]), Deadline(), random.choice([INFINITE_KEY, 1 << 33, 1 << 34]))
    assert canonical_plan(planner, packed.init, Deadline()) == expected


@given(tasks())
def test_plans_are_known_from_states_whose_cost_was_found(task: Task) -> None:
    packed = packed_of(task)
    planner, costs = planner_of(packed), exact(packed)
    for state, cost in costs.items():
        found = planner.cheapest(state, Deadline())
        plan = planner.known_plan(state, Deadline())
        assert (plan is None) == (found == INFINITE_KEY)
        if plan is not None:
            assert assert_leads_to_goal(packed, state, plan) == cost


@given(tasks())
def test_what_was_come_across_is_a_plan(task: Task) -> None:
    packed = packed_of(task)
    for state, cost in exact(packed).items():
        planner = planner_of(packed)
        assert planner.best_so_far(state) is None
        planner.cheapest(state, Deadline(), limit=cost)  # none is below
        found = planner.best_so_far(state)
        assert found is None or assert_leads_to_goal(packed, state, found) == 0  # a goal


@pytest.mark.long
def test_an_interrupted_search_keeps_its_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("search.classical.planner.SLICE", 0)
    packed = packed_of(CORRIDOR)
    planner, cost = planner_of(packed), exact(packed)[packed.init]
    kept = []
    for looks in range(1000):
        planner = planner_of(packed)
        try:
            planner.cheapest(packed.init, Countdown(looks))
        except LimitReachedError:
            kept.append(planner.best_so_far(packed.init))
        else:
            break
    plans = [plan for plan in kept if plan is not None]
    assert kept
    for plan in plans:
        assert assert_leads_to_goal(packed, packed.init, plan) >= cost


def test_the_clock_is_looked_at_while_a_long_plan_is_put_together() -> None:
    many = 200
    chores = {f"do{i} h": f"-> done{i}" for i in range(many)}
    packed = packed_of(task(goal=" ".join(f"done{i}" for i in range(many)), actions=chores))
    planner = planner_of(packed)
    planner.cheapest(packed.init, Deadline())
    assert sorted(planner.known_plan(packed.init, Countdown(20)) or ()) == [*range(many)]
    with pytest.raises(LimitReachedError):
        planner.known_plan(packed.init, Countdown(5))
    with pytest.raises(LimitReachedError):
        in_order(planner.problem.operators, range(many), Countdown(100))
