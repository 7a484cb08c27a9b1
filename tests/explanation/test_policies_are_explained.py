"""What robots wait to see, and what watching is worth, in an answer over scenarios."""

import pytest

import serendipity
from serendipity.model import Condition, UsageError

GOALS = [
    {"name": room, "goal": [f"conducted_triage commx {room}"], "prior": prior}
    for room, prior in (("room1", 2), ("room3", 1), ("room9", 1))
]


def test_what_watching_is_worth() -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.9", goals=GOALS)
    found = serendipity.explain_policy(task, answer)
    fixed = serendipity.plan(task, discount="0.9", goals=GOALS, policy="fixed")
    singles = [serendipity.plan(task, discount="0.9", goals=[goal]).cost for goal in GOALS]
    assert float(found.committed) == fixed.cost > answer.cost
    assert float(found.knowing) == pytest.approx(
        sum(g.probability * cost for g, cost in zip(answer.goals, singles, strict=True))
    )
    first = [sign for sign in found.signs if sign.epoch == 1]
    assert {sign.after for sign in first} == {(0, 2), (1,)}
    assert all(sign.waited_for for sign in first)


def test_it_is_about_several_scenarios() -> None:
    task = serendipity.example("room2")
    with pytest.raises(UsageError, match="several goals or plans"):
        serendipity.explain_policy(task, serendipity.plan(task))
    with pytest.raises(UsageError, match="several goals or plans with risk mean, got worst"):
        serendipity.explain_policy(task, serendipity.plan(task, goals=GOALS, risk="worst"))


def test_each_plan_of_a_goal_is_one_for_it() -> None:
    task = serendipity.example("parcels")
    goals = [{"name": "all", "goal": [task.facts[i] for i in task.goal.positive]}]
    answer = serendipity.plan(task.with_goal(Condition()), discount="0.9", goals=goals, ties="watched")
    assert [scenario.name for scenario in answer.goals] == ["all 1", "all 2"]
    found = serendipity.explain_policy(task.with_goal(Condition()), answer)
    assert found.knowing <= answer.cost <= found.committed


def test_getting_up_late_is_seen_where_it_is_not_done_yet() -> None:
    task = serendipity.example("morning")
    known = serendipity.plan(task, mode="individual")
    plan = known.human_plan_times.entries(known.human_plan)
    later = [(epoch + 4, action) for epoch, action in plan]
    answer = serendipity.plan(task, plans=[{"probability": 1, "plan": one} for one in (plan, later)])
    found = serendipity.explain_policy(task, answer)
    assert [(sign.epoch, sign.action) for sign in found.signs] == [(4, "dress ann"), (4, None)]
    assert found.knowing <= answer.cost <= found.committed
