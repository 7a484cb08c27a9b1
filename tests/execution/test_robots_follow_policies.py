"""Robots who don't know the goal of somebody who is told: they follow a policy (semantics 11)."""

from fractions import Fraction
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import Execution, Omniscient, Replanner
from serendipity.execution.hypotheses import Hypotheses
from serendipity.model import LimitReachedError, Task
from serendipity.testing.builders import task as build
from serendipity.testing.strategies import tasks
from tests.execution.living import GOALS, ROOMS, aiming_at, live, lived, other_goals, told, verdicts
from verify.base.optimal_plans import OptimalPlans


@pytest.mark.parametrize("room", ROOMS)
def test_the_robot_waits_to_see_where_they_go(room2: Task, room: str) -> None:
    run = told(aiming_at(room2, room), goals=GOALS)
    first, second = (passed.decided for passed in run.passed[:2])
    assert first.reason.startswith("waits: not sure which goal") and not first.actions
    assert first.wishes["room3"] is None, "who needs no help waits for an epoch, which costs nothing"
    if room == "room3":
        assert second.goals == {"room1": 0, "room3": 1, "room9": 0}
        assert set(verdicts(run)[1:]) == {"aside"} and run.cost == run.human_cost == 9
    else:
        assert second.goals == {"room1": 0.5, "room3": 0, "room9": 0.5}
        assert verdicts(run)[1:6] == ["helps"] * 5 and (run.cost, run.human_cost) == (Fraction(57, 5), 11)


def test_help_is_worth_what_the_policy_promises(room2: Task) -> None:
    promised = serendipity.plan(room2, discount="0.9", goals=GOALS)
    costs = [float(told(aiming_at(room2, room), goals=GOALS).cost) for room in ROOMS]
    assert costs == [one.cost for one in promised.goals or ()]


def test_who_leaves_the_tree_is_watched_anew(room2: Task) -> None:
    run = Execution(aiming_at(room2, "room1"), discount="0.9", goals=GOALS, told=True)
    run.step("move commx room13 hall8")
    run.step("move_reverse commx hall8 room13")
    assert set(run.decided.goals.values()) == {1 / 3}, "it is no part of any plan"
    assert lived(run, Omniscient(aiming_at(room2, "room1"))).done


def test_what_was_pledged_is_kept_without_time(room2: Task, monkeypatch: pytest.MonkeyPatch) -> None:
    """Robots did nothing, and the person was left without the plan and without the kit."""
    task = aiming_at(room2, "room1")
    run = Execution(task, discount="0.9", goals=GOALS, told=True)
    lived(run, Omniscient(task), most=4)

    def too_late(*_: object) -> None:
        raise LimitReachedError("time-limit")

    monkeypatch.setattr(Hypotheses, "look", too_late)
    assert "late" not in verdicts(lived(run, Omniscient(task))) and float(run.cost) == 11.4


def test_goals_that_nobody_reaches_alone_are_tried_one_after_the_other() -> None:
    doors = {f"open {way} r": f"-> open_{way}" for way in "ab"}
    ways = {f"go h {way}": f"s open_{way} -> {way} !s" for way in "ab"}
    task = build(init="s", goal="b", actions={**doors, **ways})
    assert told(task, goals=[{"name": way, "goal": [way]} for way in "ab"]).done


def test_whose_goal_is_none_of_them_goes_on_alone(room2: Task) -> None:
    run = told(aiming_at(room2, "room8"), goals=GOALS)
    assert run.goal is None and run.done
    row = serendipity.execute(aiming_at(room2, "room8"), "omniscient", goals=GOALS, discount="0.9").rows[0]
    assert row.reached and row.known is None


def test_the_last_goal_is_asked_about_again_and_again(room2: Task) -> None:
    """It was an error: the session took the only plan of one epoch for the person's in the next."""
    run = Execution(room2, discount="0.9", human_model="omniscient", goals=GOALS[:1])
    assert lived(run, Replanner(room2)).done


@given(tasks(), st.sampled_from(["0", "0.5", "0.9", "1"]), st.integers(0, 2**32))
def test_nobody_who_follows_their_plan_pays_more(task: Task, discount: str, seed: int) -> None:
    alone = OptimalPlans(task).cost(task.init)
    if alone is None or task.robot_goal:
        return
    run = told(task, discount=discount, goals=other_goals(task, Random(seed)))
    assert run.done and run.human_cost <= alone


@given(tasks(), st.sampled_from(["0", "0.5", "0.9", "1"]), st.integers(0, 2**32))
def test_who_is_not_told_pays_no_more_either(task: Task, discount: str, seed: int) -> None:
    goals = other_goals(task, Random(seed))
    live(task, Execution(task, discount=discount, human_model="omniscient", goals=goals), Replanner(task))
