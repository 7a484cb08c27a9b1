"""The human alone in time: the canonical plan of brute force, at the cost of the few epochs that matter."""

import pytest
from hypothesis import given

import serendipity
from benchmarks.problems import building
from search import PreparedTask, canonical_human_plan
from serendipity.model import Deadline, HumanPlan, Options, Script, Task
from serendipity.model.task.unit_steps import unit_steps
from serendipity.testing.builders import task
from serendipity.testing.generator import random_call_in_time
from serendipity.testing.oracle import optimal_human_plan
from serendipity.testing.strategies.time import tasks_in_time
from tests.search.time.days import day, slowed

Told = tuple[list[str], tuple[int, ...], int] | None


def told(built: Task, plan: HumanPlan | None) -> Told:
    """Names and beginnings of a plan's actions, and its length."""
    if plan is None:
        return None
    return [built.actions[i].name for i in plan], built.starts_of(plan), built.epochs_of(plan)


@given(tasks_in_time())
def test_plans_alone_are_the_canonical_ones(built: Task) -> None:
    units = unit_steps(built)
    plan = canonical_human_plan(PreparedTask(units.task), Deadline(), Options())
    found = told(built, None if plan is None else units.begun(plan))
    assert found == told(built, optimal_human_plan(built))


def test_epochs_in_which_nothing_can_begin_cost_nothing() -> None:
    actions = {"a h": "open -> f", "b h": "f -> g", "c r": "-> open @ 5"}
    built = task(agents="h r", human="h", goal="g", actions=actions)
    answers = [
        serendipity.plan(built.with_script(Script(facts=[(epoch, "open")])), mode="individual")
        for epoch in (10, 50_000)
    ]
    assert [answer.horizon for answer in answers] == [12, 50_002]
    assert len({answer.statistics["expanded"] for answer in answers}) == 1


@pytest.mark.long
@pytest.mark.parametrize(("seed", "most"), [(1, 1_000), (2, 1_000)])
def test_a_day_of_a_thousand_epochs(seed: int, most: int) -> None:
    alone = serendipity.plan(day(seed), mode="individual")
    assert alone.status == "optimal"
    assert alone.statistics["expanded"] < most
    assert serendipity.plan(day(seed), discount="0.9").status == "optimal"


@pytest.mark.parametrize("robots", [1, 2])
def test_a_building_of_84_rooms_with_slow_walks(robots: int) -> None:
    answer = serendipity.plan(slowed(building(84, 4, robots, 2), 1), discount="0.9")
    assert answer.status == "optimal"
    assert answer.statistics["expanded"] < 2_000


def test_what_is_cheaper_than_waiting_is_not_done_for_ever() -> None:
    """With a price of waiting the search for a plan went on without end where there is none."""
    call = random_call_in_time(266)
    answer = serendipity.plan(call.task, mode="individual", waiting_cost="0.5", time_limit=20)
    assert (answer.status, answer.reason) == ("infeasible", "no-human-plan")
