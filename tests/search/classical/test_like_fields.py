"""Fields that are alike: which are, and that searches in which one state stands for many find the same."""

from random import Random

import pytest

import serendipity
from search.classical import planner as planner_module
from search.kernel.library import library
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model import Deadline, Task
from serendipity.model.numbers import as_written
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import best
from tests.search.classical.exact_costs import exact
from tests.search.classical.test_kernel_equals_brute_force import assert_leads_to_goal, planner_of
from tests.search.small_tasks import fetching, packed_of

pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")


def cups(dear: str = "", wanted: str = "tuv") -> Task:
    """Three cups to be carried from a shelf through the hands of one to a table."""
    actions = {"go h": "!busy -> busy"}
    for cup in "tuv":
        price = 2 if cup == dear else 1
        actions[f"take_{cup} h"] = f"busy {cup}_in_shelf -> {cup}_held !{cup}_in_shelf @ {price}"
        actions[f"put_{cup} h"] = f"busy {cup}_held -> {cup}_on_table !{cup}_held !busy"
    init = " ".join(f"{cup}_in_shelf" for cup in "tuv")
    return build(init=init, goal=" ".join(f"{cup}_on_table" for cup in wanted), actions=actions)


@pytest.mark.parametrize(("task", "sizes"), [(cups(), [3]), (cups(dear="u"), [2]), (cups(wanted="tu"), [2])])
def test_things_that_cost_and_are_wanted_alike_are(task: Task, sizes: list[int]) -> None:
    assert list(map(len, planner_of(packed_of(task)).alike(Deadline()))) == sizes


@pytest.mark.parametrize("late", [0, 4])
def test_costs_are_exact_and_plans_are_plans(late: int) -> None:
    """Also where it is found out late, by what is known of states that others stand for now."""
    several = 0
    for seed in range(60):
        dice = Random(seed)
        packed = packed_of(fetching(dice))
        planner, costs = planner_of(packed), exact(packed)
        known: dict[int, int] = {}
        for number, state in enumerate(dice.sample([*costs], min(40, len(costs)))):
            if number == late:
                several += bool(planner.alike(Deadline()))
            cost = costs[state]
            limit = dice.choice([INFINITE_KEY, cost, min(cost + 1, INFINITE_KEY)])
            some = dice.choice([*costs])
            assert planner.bound(some, Deadline()) <= costs[some], seed
            found = planner.cheapest(state, Deadline(), limit)
            assert found == cost if cost < limit else found >= limit, seed
            if found < min(limit, INFINITE_KEY):
                for plan in (planner.known_plan(state, Deadline()), planner.best_so_far(state)):
                    assert assert_leads_to_goal(packed, state, plan or []) == cost, seed
                known[state] = cost
        for state, cost in known.items():
            assert assert_leads_to_goal(packed, state, planner.known_plan(state, Deadline()) or []) == cost, (
                seed
            )
    assert several > 30


def test_a_search_that_finds_out_on_its_way_begins_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(planner_module, "SLICE", 1e-6)
    monkeypatch.setattr(planner_module, "_SOME", 3)
    for seed in range(20):
        packed = packed_of(fetching(Random(seed)))
        planner, cost = planner_of(packed), exact(packed)[packed.init]
        found = planner.cheapest(packed.init, Deadline())
        assert found == cost
        if found < INFINITE_KEY:
            best_plan = planner.best_so_far(packed.init)
            assert assert_leads_to_goal(packed, packed.init, best_plan or []) == cost


@pytest.mark.long
def test_answers_are_those_of_brute_force(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(planner_module, "_SOME", -1)
    helped = 0
    for seed in range(12):
        dice = Random(seed)
        task, asked = fetching(dice), {"discount": dice.choice(["0.5", "0.9"])}
        answer = serendipity.plan(task, max_window=1, strategies="-few-nodes,-robots-apart", **asked)
        if answer.status == "optimal":
            assert as_written(answer.cost) == best(task, answer.options).cost, seed
            assert serendipity.check(task, answer).verdict != "refuted"
            helped += answer.opportunity
    assert helped > 4
