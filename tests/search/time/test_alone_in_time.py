"""The human alone in time: the canonical plan of brute force, at the cost of the few epochs that matter."""

from fractions import Fraction
from random import Random
from typing import Any

import pytest
from hypothesis import given

import serendipity
from benchmarks.problems import building
from search import PreparedTask, canonical_human_plan
from serendipity.model import Deadline, HumanPlan, Options, Script, Task
from serendipity.model.task.passing import epoch_later
from serendipity.model.task.unit_steps import unit_steps
from serendipity_testing.builders import task
from serendipity_testing.generator import random_call_in_time
from serendipity_testing.oracle import best, optimal_human_plan
from serendipity_testing.strategies.time import tasks_in_time
from tests.search.time.days import day, slowed, with_a_robot_at_work

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


@pytest.mark.parametrize("seed", range(0, 120, 3))
def test_plans_beside_what_robots_are_at_are_the_canonical_ones(seed: int) -> None:
    now = with_a_robot_at_work(random_call_in_time(seed).task, Random(seed))
    units = unit_steps(now)
    plan = canonical_human_plan(PreparedTask(units.task), Deadline(), Options())
    found = told(now, None if plan is None else units.begun(plan))
    assert found == told(now, optimal_human_plan(now))


def test_epochs_in_which_a_robot_is_only_at_work_cost_nothing() -> None:
    """Beside a robot at work each epoch was looked at, and a day took more than four minutes."""
    counts = []
    for epochs in (10, 500):
        actions = {"a h": "-> !done f @ 3", "b h": "f done -> g", "c r": f"-> / !g / -> done @ 1 [{epochs}]"}
        built = task(agents="h r", human="h", goal="g", actions=actions)
        now = epoch_later(built, [action for action in built.actions if action.name == "c r"])
        answer = serendipity.plan(now, mode="individual")
        assert (answer.status, answer.horizon) == ("optimal", epochs)
        counts.append(answer.statistics["expanded"])
    assert len(set(counts)) == 1


@pytest.mark.long
@pytest.mark.parametrize(("seed", "begun"), [(1, "walk robot kitchen hall"), (3, "do robot 2")])
def test_a_day_beside_a_robot_at_work(seed: int, begun: str) -> None:
    home = day(seed)
    now = epoch_later(home, [home.actions[home.named[begun][0]]])
    alone = serendipity.plan(now, mode="individual")
    assert (alone.status, alone.statistics["expanded"] < 1_000) == ("optimal", True)
    assert serendipity.plan(now, discount="0.9").status == "optimal"


def test_who_is_at_work_at_first_is_at_one_thing() -> None:
    """It was a fact for each epoch of each of their actions, and a day beside a robot at work had no end."""
    home = day(1)
    now = epoch_later(home, [home.actions[home.named["walk robot kitchen hall"][0]]])
    assert len(unit_steps(now).task.variables) == len(unit_steps(home).task.variables)


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


@pytest.mark.parametrize("epoch", [2, 3, 6])
def test_a_head_start_is_paid_for_by_who_acts_after_it(epoch: int) -> None:
    """What a given plan had waited was left out of what they gain alone, or a dearer plan was taken.

    The goal comes by itself.  Where an action was done sooner, it was as if the head start cost nothing.
    """
    built = task(
        agents="h r", human="h", goal="g", actions={"a h": "-> g @ 0", "b h": "-> g @ 1", "c r": "-> g"}
    )
    built = built.with_script(Script(facts=[(epoch, "g")]))
    call: dict[str, Any] = {"mode": "individual", "head_start": 1, "waiting_cost": "0.5"}
    for told_plan, paid in ((["a h"], 0.5), (["b h"], 1.5), ([(3, "a h")], 1.5)):
        answer = serendipity.plan(built, human_plan=told_plan, **call)
        assert (answer.cost, answer.saving_alone) == (0, paid)
        assert serendipity.verify(built, answer).verdict == "proved"
        plan = built.plan_from_names(told_plan, 1)
        assert best(built, Options(**call), plan).saving_alone == Fraction(str(answer.saving_alone))
