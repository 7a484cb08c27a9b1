"""What watching is worth in an answer over scenarios, and what rules of help allow (semantics 11 to 14).

Nothing is said of help under rules that holds only without them.
"""

from fractions import Fraction

import pytest

import serendipity
from serendipity import Explanation, Script
from serendipity.model import Condition, InputError, UsageError
from serendipity_testing.builders import task as build

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


def explained(**options: object) -> Explanation:
    morning = serendipity.example("morning")
    return serendipity.explain(morning, serendipity.plan(morning, **options))


def missed(found: Explanation) -> dict[str, float]:
    return {miss.rule: miss.cost for miss in found.misses}


def test_help_that_is_not_noticed() -> None:
    found = explained(noticed=True, discount=0.9)
    assert not found.answer.opportunity
    assert (found.moments, found.window_weight) == ((), None)
    assert missed(found) == {"prefix": 29.4, "noticed": 29.4}


def test_nothing_may_be_left() -> None:
    found = explained(leave_free="", discount=0.5)
    assert (found.answer.cost, found.moments) == (36, ())  # 35, in other windows too, leaves robi elsewhere
    assert missed(explained(leave_free="", discount=0.2)) == {"leave_free": 39.2}


def test_what_is_left_has_its_price_at_every_discount() -> None:
    found = explained(leave_price="coffee=0.5, table-laid=1, *=0.5", discount=0.5)
    assert (found.parts.human, found.parts.robots, found.parts.left) == (28, 14, 1)
    assert found.to_dict()["left_part"] == 1
    assert any("what is left changed costs 1; together 36" in text for _, text in found.sentences)
    assert (found.discount.value, found.discount.included) == (Fraction(3, 14), False)
    assert [c.opportunity for c in found.discount.confirmed] == [False, False, True]


def test_somebody_else_would_pay() -> None:
    actions = {"fetch h": "-> done @ 5", "bring r": "cup -> done !cup", "drink c": "cup -> drunk"}
    built = build(init="cup", goal="done", actions=actions, agents="h r c")
    beside = built.with_script(Script(people={"c": [(3, "drink c")]}))
    found = serendipity.explain(beside, discount=0.5)
    assert not found.answer.opportunity
    assert missed(found)["nobody_pays"] == 0.5


def test_committed_robots_are_told_what_watching_would_be_worth() -> None:
    task = serendipity.example("room2")
    fixed = serendipity.plan(task, discount="0.9", goals=GOALS, policy="fixed")
    watching = serendipity.plan(task, discount="0.9", goals=GOALS)
    found = serendipity.explain_policy(task, fixed)
    assert (float(found.committed), float(found.watching)) == (fixed.cost, watching.cost)
    assert "watching would be worth 0.1: robots that watch cost 10.8" in str(found)


def test_a_goal_without_literals_is_one() -> None:
    actions = {"one h": "!a -> a", "two h": "a -> b @ 3", "fix r": "-> d", "lift h r": "a d -> b @ 1"}
    task = build(goal="b", actions=actions)
    plans = [
        {"probability": 1, "plan": ["one h", "two h"], "goal": []},
        {"probability": 1, "plan": ["one h"], "goal": ["a"]},
    ]
    answer = serendipity.plan(task, plans=plans, discount=1, window_weight=0)
    found = serendipity.explain_policy(task, answer)
    assert float(found.committed) == answer.cost == 2.5


def test_explain_leaves_policies_to_its_sister_and_knows_the_goal_of_one() -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.9", goals=GOALS)
    with pytest.raises(UsageError, match="is explained by explain_policy"):
        serendipity.explain(task, answer)
    with pytest.raises(InputError, match="over several goals or plans"):
        serendipity.simulate(task, answer)
    only = serendipity.plan(task, discount="0.9", goals=GOALS[-1:])
    assert serendipity.explain(task, only).answer.cost == only.cost == 11.4
    assert serendipity.simulate(task, only).realised
