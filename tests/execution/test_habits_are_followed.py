"""Robots who know somebody's habits: a library of plans, of which a plan is out once they go on otherwise.

And robots who don't know the goal of somebody who is told: they follow a policy (semantics 11).
"""

from fractions import Fraction
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import Execution, Omniscient, Replanner
from serendipity.execution.hypotheses import Hypotheses
from serendipity.model import LimitReachedError, Task
from serendipity.model.task.actions import apply
from serendipity_testing.builders import task as build
from serendipity_testing.strategies import tasks
from tests.execution.living import GOALS, ROOMS, aiming_at, as_lines, live, lived, other_goals, told, verdicts
from verify.base.optimal_plans import OptimalPlans

WAYS = {
    f"go h {start} {end}": f"{start} -> {end} !{start}"
    for start, end in ("ab", "bd", "ac", "cd", "ce", "de", "bf", "fd")
}
"""From a to d by b or by c, or from b by f, which nobody who saves does; to e by c or d."""


def _home(**actions: str) -> Task:
    return build(init="a", goal="d", actions=WAYS | {"lift r": "-> up"} | actions)


def _habit(probability: float, *steps: str, goal: str = "d") -> dict[str, Any]:
    names = [f"go h {start} {end}" for start, end in steps]
    return {"name": " ".join(steps), "probability": probability, "plan": names, "goal": [goal]}


BY_B, BY_C, ROUND = _habit(0.25, "ab", "bd"), _habit(0.25, "ac", "cd"), _habit(0.5, "ab", "bf", "fd")


def test_canonical_plans_are_goals(room2: Task) -> None:
    """What robots do is that of ``--goals``, if the habits are those that it takes for granted."""
    known = serendipity.recognise(room2, GOALS).goals
    plans = [{**goal, "probability": 1, "plan": one.plan} for goal, one in zip(GOALS, known, strict=True)]
    for room in ROOMS:
        task = aiming_at(room2, room)
        by_plans, by_goals = told(task, plans=plans), told(task, goals=GOALS)
        assert [p.steps for p in by_plans.passed] == [p.steps for p in by_goals.passed]
        assert [p.decided.goals for p in by_plans.passed] == [p.decided.goals for p in by_goals.passed]
        serendipity.execution.replay(task, as_lines(by_plans))


def test_a_plan_is_out_once_they_go_on_otherwise() -> None:
    run = Execution(_home(), plans=[BY_B, BY_C, ROUND])
    assert run.options.human_model == "omniscient"
    assert run.decided.goals == {"ab bd": 0.25, "ac cd": 0.25, "ab bf fd": 0.5}
    run.step("go h a b")
    assert run.decided.goals == pytest.approx({"ab bd": 1 / 3, "ac cd": 0, "ab bf fd": 2 / 3})
    run.step()
    assert run.decided.goals == pytest.approx({"ab bd": 1 / 3, "ac cd": 0, "ab bf fd": 2 / 3}), "who is late"
    run.step("go h b f")
    assert run.decided.goals == {"ab bd": 0, "ac cd": 0, "ab bf fd": 1}
    run.step("go h f d")
    assert run.done


def test_a_dear_habit_is_kept() -> None:
    """It was dropped for the cheapest plan, which nobody with that habit follows."""
    run = Execution(_home(), plans=[ROUND])
    run.step("go h a b")
    assert run.decided.alone == 2, "by f, though d is one step away"


def test_what_was_tried_in_vain_is_tried_again() -> None:
    run = Execution(_home(), plans=[BY_B, BY_C, ROUND])
    run.change({"a": False})
    assert run.step("go h a b").in_vain
    run.change({"a": True})
    assert run.decided.goals["ac cd"] == 0
    run.step("go h a b")
    run.step("go h b f")
    assert run.decided.goals["ab bf fd"] == 1


def test_with_no_plan_left_their_goals_are_what_is_known() -> None:
    run = Execution(_home(), plans=[_habit(0.75, "ab", "bd"), _habit(0.25, "ab", "bd", "de", goal="e")])
    run.step("go h a c")
    assert run.decided.goals == {"ab bd": 0.75, "ab bd de": 0.25}
    run.step("go h c e")
    goals = run.decided.goals
    assert goals["ab bd de"] > goals["ab bd"], "now the posterior weighs what they do"


def test_who_is_told_takes_a_part_that_their_habit_does_not_have() -> None:
    """The ride is in no plan of the library, and rules none out, for the robots' policy has it."""
    ride = {"ride h r": "b up -> d !b", "go h b d": "b -> d !b @ 9", "go h c d": "c -> d !c @ 9"}
    run = told(_home(**ride), plans=[ROUND, _habit(0.5, "ab", "bf", goal="f")], discount="0.9")
    assert run.goal == "ab bf fd" and run.done and (run.cost, run.human_cost) == (Fraction(21, 10), 2)
    assert [passed.decided.goals[run.goal] for passed in run.passed] == [0.5, 0.5]
    assert run.decided.goals == {"ab bf fd": 1, "ab bf": 0}


def test_the_dice_draw_which_habit_is_theirs() -> None:
    runs = serendipity.execute(_home(), "omniscient", plans=[BY_B, BY_C], ties="drawn", runs=20)
    first = {lines[1]["human"] for lines in runs.logs}
    assert first == {"go h a b", "go h a c"} and all(row.reached for row in runs.rows)
    assert all(row.known == 2 for row in runs.rows)


def test_a_record_of_a_habit_is_helped_as_one() -> None:
    runs = serendipity.execute(_home(), BY_C["plan"], plans=[BY_B, BY_C], deadline=5)
    (row,) = runs.rows
    assert row.reached and row.human_cost == 2 and row.known is None, "which of them is theirs, nobody says"


def _habits(task: Task, dice: Random) -> list[dict[str, Any]]:
    """Plans to the goal that begin anyhow, and go on as it is best."""
    found: dict[tuple[str, ...], dict[str, Any]] = {}
    for _ in range(dice.randint(1, 3)):
        state, names = task.init, []
        for _ in range(dice.randint(0, 2)):
            able = [i for i in task.human_actions if task.actions[i].applicable(state)]
            if able:
                chosen = dice.choice(able)
                names.append(task.actions[chosen].name)
                state = apply(state, task.actions[chosen])
        rest = serendipity.plan(task.at(state), mode="individual").human_plan
        if rest is not None:
            plan = (*names, *rest)
            found[plan] = {"name": ", ".join(plan), "probability": dice.randint(1, 4), "plan": list(plan)}
    return list(found.values())


@given(tasks(), st.sampled_from(["0", "0.5", "0.9", "1"]), st.integers(0, 2**32))
def test_habits_are_never_dearer_with_robots(task: Task, discount: str, seed: int) -> None:
    plans = [] if task.robot_goal else _habits(task, Random(seed))
    if not plans:
        return
    costs = {one["name"]: task.cost_of(task.plan_from_names(one["plan"])) for one in plans}
    run = lived(Execution(task, discount=discount, plans=plans, told=True), Omniscient(task))
    assert run.done and run.human_cost <= costs[run.goal or ""]
    chosen = Random(seed).choice(plans)
    run = Execution(task, discount=discount, plans=plans)
    for name in chosen["plan"]:
        if not run.done:
            assert not run.step(name).in_vain, "robots spoilt the habit that was followed"
    assert run.done and run.human_cost <= costs[chosen["name"]]


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
