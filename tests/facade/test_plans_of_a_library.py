"""Plans that the human may follow, each with a goal of its own: answered, told and proved."""

import time
from typing import Any

import pytest

import serendipity
from serendipity.model import Result, UsageError
from serendipity.testing.builders import task as build


def test_plans_with_goals_of_their_own_are_proved() -> None:
    task = serendipity.example("room2")
    goals = {room: [f"conducted_triage commx {room}"] for room in ("room1", "room3", "room9")}
    alone = {
        room: serendipity.plan(task, goals=[{"name": room, "goal": goal}]).human_plan
        for room, goal in goals.items()
    }
    plans = [
        {"name": room, "probability": 1, "goal": goals[room], "plan": list(alone[room])} for room in goals
    ]
    by_plans = serendipity.plan(task, discount="0.9", plans=plans)
    by_goals = serendipity.plan(
        task, discount="0.9", goals=[{"name": room, "goal": goal} for room, goal in goals.items()]
    )
    assert (by_plans.cost, by_plans.objective) == (by_goals.cost, by_goals.objective)
    read = Result.from_dict(by_plans.to_dict())
    assert [scenario.goal for scenario in read.goals] == [None, *map(tuple, list(goals.values())[1:])]
    assert serendipity.verify(task, read).verdict == "proved"


def test_one_plan_is_a_given_one() -> None:
    task = serendipity.example("room2")
    plan = serendipity.plan(task, mode="individual").human_plan
    found = serendipity.plan(
        task, discount="0.9", plans=[{"name": "it", "probability": 1, "plan": list(plan)}]
    )
    known = serendipity.plan(task, discount="0.9", human_plan=plan)
    assert found.to_dict() | {"statistics": None} == known.to_dict() | {"statistics": None}


@pytest.mark.parametrize("more", [{"observed": ["go h"]}, {"beta": 2}, {"noise": "miss=0.1"}])
def test_what_tells_goals_goes_with_goals_only(more: dict[str, Any]) -> None:
    task = serendipity.example("room2")
    for plans in (None, [{"probability": 1, "plan": []}]):
        with pytest.raises(UsageError, match=f"^{next(iter(more))}: goes with goals only$"):
            serendipity.plan(task, plans=plans, **more)


@pytest.mark.long
def test_limits_hold_beside_plans_of_many_epochs() -> None:
    task = build(init="", goal="lunch", actions={"pack h": "-> lunch", "help r": "-> lunch"})
    plans = [{"name": str(epoch), "probability": 1, "plan": [[epoch, "pack h"]]} for epoch in (1, 20_000)]
    began = time.process_time()
    found = serendipity.plan(task, plans=plans, time_limit=1)
    assert (found.human_cost, time.process_time() - began < 6) == (1, True)


@pytest.mark.parametrize("asked", [{"risk": "worst"}, {"policy": "fixed"}], ids=str)
def test_what_says_something_of_several_plans_only_is_refused_of_one(asked: dict[str, Any]) -> None:
    task = serendipity.example("room2")
    with pytest.raises(UsageError, match=f"^{next(iter(asked))}: goes with goals, plans or ties 'watched'$"):
        serendipity.plan(task, **asked)
    one = [{"goal": [task.facts[i] for i in task.goal.positive]}]
    assert serendipity.plan(task, ties="watched", **asked).cost is not None
    assert serendipity.explain(task, serendipity.plan(task, goals=one, **asked)).answer.cost is not None


def test_a_session_is_asked_about_plans_again() -> None:
    task = serendipity.example("room2")
    plans = [{"probability": 1, "plan": list(serendipity.plan(task).human_plan or ())}]
    session = serendipity.Session(task)
    assert session.plan(plans=plans).cost == session.plan(plans=plans).cost
