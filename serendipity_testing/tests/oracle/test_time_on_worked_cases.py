"""Brute force on cases of time that are worked out by hand (docs/semantics.md, section 10)."""

from fractions import Fraction
from typing import Any

import pytest

from serendipity.model import Condition, Options, PlanError, Script, Task, UsageError, Window
from serendipity_testing.builders import task
from serendipity_testing.oracle import best, human_plans, optimal_human_plan
from serendipity_testing.oracle.alone import with_predicted

HALF = "0.5"


def corridor(duration: int = 1, *, door: bool = False, **more: str) -> Task:
    """Rooms a-b-c-d; the human goes from a to d; with a door before d."""
    actions = dict(more)
    for x, y in ("ab", "bc", "cd"):
        opened = " open" if door and y == "d" else ""
        for here, there in ((x, y), (y, x)):
            actions[f"move h {here} {there}"] = f"{here}{opened} -> {there} !{here} @ 1 [{duration}]"
    return task(init="a", goal="d", actions=actions)


def door(**more: str) -> Task:
    """The corridor whose door opens with epoch 8; a robot may open it before."""
    return corridor(door=True, **{"open r": " -> open @ 2", **more}).with_script(Script(facts=[(8, "open")]))


def carol(plan: Any = ((2, "move carol c b"), (3, "move carol b e"))) -> Task:
    """The corridor with a side room e behind b, in which nobody stands where somebody is, and Carol."""
    actions = {}
    for who in ("h", "carol", "r"):
        for x, y in ("ab", "bc", "cd", "be"):
            for a, b in ((x, y), (y, x)):
                actions[f"move {who} {a} {b}"] = (
                    f"{who}-{a} clear-{b} -> {who}-{b} !{who}-{a} clear-{a} !clear-{b}"
                )
    init = "h-a carol-c clear-b clear-e clear-d"
    empty = task(agents="h r carol", init=init, goal="h-d", actions=actions)
    return empty if plan is None else empty.with_script(Script(people={"carol": plan}))


def test_moves_of_two_epochs_cost_once() -> None:
    moves = corridor(2)
    plan = optimal_human_plan(moves)
    assert plan is not None
    assert (moves.cost_of(plan), moves.epochs_of(plan)) == (3, 6)
    assert best(moves, Options(discount=HALF)).cost == 3


def test_a_door_is_waited_for_where_they_stand_before_it() -> None:
    shut = corridor(door=True).with_script(Script(facts=[(8, "open")]))
    plan = optimal_human_plan(shut)
    assert plan is not None
    assert [shut.actions[i].name for i in plan] == ["move h a b", "move h b c", "move h c d"]
    assert (shut.starts_of(plan), shut.epochs_of(plan)) == ((1, 2, 9), 9)
    assert len([*human_plans(shut)]) == 1
    answer = best(shut, Options(discount=HALF))
    assert (answer.cost, answer.opportunity) == (3, False)


def test_waiting_that_costs_is_worth_an_opened_door() -> None:
    costs = {"discount": HALF, "waiting_cost": "1"}
    assert best(door(), Options(mode="individual", **costs)).cost == 9
    helped = best(door(), Options(**costs))
    assert (helped.cost, helped.window, helped.saving) == (4, Window(3, 4), 5)
    for mode in ("composite", "communication"):
        assert best(door(), Options(mode=mode, **costs)).cost == 4
    assert best(door(), Options(mode="composite", horizon="inf", **costs)).cost == 4


def test_waiting_that_is_free_is_no_reason_to_help() -> None:
    assert best(door(), Options(discount=HALF)).opportunity is False


def test_nobody_is_in_carols_way() -> None:
    plan = optimal_human_plan(carol())
    assert plan is not None
    assert carol().starts_of(plan) == (4, 5, 6)
    answer = best(carol(), Options(discount=HALF))
    assert (answer.cost, answer.opportunity) == (3, False)


def test_bystanders_can_be_predicted() -> None:
    wanted = Condition((carol().facts.index("carol-e"),))
    there = with_predicted(carol(None), {"carol": wanted})
    assert [(deed.epoch, deed.name) for deed in there.script.deeds] == [
        (1, "move carol c b"),
        (2, "move carol b e"),
    ]
    plan = optimal_human_plan(there)
    assert plan is not None
    assert there.starts_of(plan) == (3, 4, 5)
    with pytest.raises(UsageError, match="carol has no plan alone"):
        with_predicted(carol(None), {"carol": Condition((carol().facts.index("h-d"),))})


def test_a_plan_that_is_in_carols_way_is_none() -> None:
    there = carol()
    moves = [there.named[f"move h {way}"][0] for way in ("a b", "b c", "c d")]
    with pytest.raises(PlanError, match="human plan"):
        best(there, Options(discount=HALF), tuple(moves))


def test_a_bystander_whom_nobody_can_let_pass_leaves_no_plan() -> None:
    blocked = carol([(1, "move carol c b"), (2, "move carol b a")])
    assert best(blocked, Options(mode="individual")).reason == "no-human-plan"


def test_what_the_plan_reaches_has_to_last_until_the_horizon() -> None:
    lost = corridor().with_script(Script(facts=[(5, "!d")]))
    assert best(lost, Options(discount=HALF)).cost == 3
    with pytest.raises(UsageError, match="horizon"):
        best(lost, Options(discount=HALF, horizon=5))


@pytest.mark.parametrize(("start", "cost"), [(0, "4"), (1, "2.1"), (2, "2.1")])
def test_a_head_start_is_time_to_help(start: int, cost: str) -> None:
    """The human carries what the robot, two rooms away, carries for less."""
    home = errand()
    assert best(home, Options(discount="0.9", head_start=start)).cost == Fraction(cost)


def errand() -> Task:
    """A human who fetches something (3) and eats (1), and a robot that comes and brings it."""
    return task(
        init="bed far",
        goal="fed",
        actions={
            "fetch h": "bed -> here @ 3",
            "eat h": "here bed -> fed @ 1",
            "go r": "far -> near !far @ 1",
            "bring r": "near -> here @ 10",
        },
    )
