"""The brute force of semantics 11 gives figures that were worked out by hand."""

from fractions import Fraction
from typing import NamedTuple

import pytest
from hypothesis import given

from serendipity.model import Condition, HumanPlan, Options, Task
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import best, optimal_human_plan
from serendipity_testing.oracle.scenarios import PolicyOptimum, best_policy
from serendipity_testing.strategies import Call, calls


class Scenario(NamedTuple):
    goal: Condition
    plan: HumanPlan
    weight: Fraction


def solved(
    task: Task, x: str, y: str, p: str = "1/2", horizon: int | None = None, **given: object
) -> PolicyOptimum:
    """The human wants fact x with probability p, else y, and their plans are these."""
    scenarios = [
        Scenario(
            Condition((task.facts.index(fact),)),
            task.plan_from_names(f"{name} h" for name in plan.split()),
            weight,
        )
        for fact, plan, weight in (("x", x, Fraction(p)), ("y", y, 1 - Fraction(p)))
    ]
    return best_policy(task, Options(**given), scenarios)  # type: ignore[arg-type]


def two_ways(*, do_x: int = 5, do_y: int = 5, quick_x: int = 1, quick_y: int = 1, rest: str = "") -> Task:
    """Epoch 1 shows what the human wants; lifting costs 1 and helps with one of the two."""
    return build(
        actions={
            "go_x h": "-> at_x",
            "go_y h": "-> at_y",
            "rest h": "-> rested",
            "lift_x r": "-> up_x",
            "lift_y r": "-> up_y",
            "do_x h": f"at_x {rest} -> x @ {do_x}",
            "do_y h": f"at_y {rest} -> y @ {do_y}",
            "quick_x h": f"at_x up_x {rest} -> x @ {quick_x}",
            "quick_y h": f"at_y up_y {rest} -> y @ {quick_y}",
        }
    )


@pytest.mark.parametrize("risk", ["mean", "worst"])
def test_who_watches_lifts_the_right_thing(risk: str) -> None:
    """In epoch 2 the robot knows; committed, it lifts both things, in epochs 1 and 2."""
    costs = {}
    for policy in ("watching", "fixed"):
        plans = ("go_x rest do_x", "go_y rest do_y")
        found = solved(two_ways(rest="rested"), *plans, policy=policy, risk=risk, discount=0)
        assert (found.baseline, found.opportunity) == (7, True)
        assert found.objective == found.cost + 1000
        costs[policy] = found.cost
    assert costs == {"watching": 4, "fixed": 5}


def test_told_apart_from_epoch_1_it_is_as_good_as_known() -> None:
    """Nothing had to be done in epoch 1, so knowing from the start is no better: nothing to regret."""
    plans = ("go_x rest do_x", "go_y rest do_y")
    watching = solved(two_ways(rest="rested"), *plans, risk="regret", discount=0)
    assert (watching.objective, watching.cost, watching.baseline) == (0, 0, 3)
    fixed = solved(two_ways(rest="rested"), *plans, risk="regret", policy="fixed", discount=0)
    assert (fixed.objective, fixed.cost) == (1, 1)


@pytest.mark.parametrize(("risk", "cost", "baseline"), [("mean", 5, 6), ("worst", 6, 6), ("regret", 3, 3)])
def test_a_guess_pays_in_the_mean_only(risk: str, cost: int, baseline: int) -> None:
    """Without rest lifting has to be done in epoch 1, at a guess: 3 where it was right, else 7."""
    found = solved(two_ways(), "go_x do_x", "go_y do_y", risk=risk, discount=0)
    assert (found.cost, found.baseline, found.opportunity) == (cost, baseline, cost < baseline)
    assert found.objective == cost + 1000 * found.opportunity


@pytest.mark.parametrize(
    ("risk", "cost", "baseline"), [("mean", "7.9", "9.6"), ("worst", "8", "10"), ("regret", "3", "4")]
)
def test_three_risks(risk: str, cost: str, baseline: str) -> None:
    """Idle: 10 or 6.  Lifting x: 8 or 7, least in the mean and at worst.  Lifting y: 11 or 2, 3 too many."""
    task = two_ways(do_x=9, quick_x=6, do_y=5, quick_y=0)
    found = solved(task, "go_x do_x", "go_y do_y", p="9/10", risk=risk, discount=0)
    assert (found.cost, found.baseline) == (Fraction(cost), Fraction(baseline))


@pytest.mark.parametrize(("lifter", "cost"), [("r", "3.5"), ("q", "2.5")])
@pytest.mark.parametrize("policy", ["watching", "fixed"])
def test_who_may_be_joined_is_idle_where_that_is_declined(lifter: str, cost: str, policy: str) -> None:
    """Riding with r, x costs 3, else 5; with the thing lifted y costs 2, else 6: both only if q lifts."""
    task = build(
        agents="h r q",
        actions={
            "go_x h": "-> at_x @ 3",
            "ride h r": "-> at_x",
            "do_x h": "at_x -> x @ 2",
            "go_y h": "-> at_y",
            "do_y h": "at_y -> y @ 5",
            "quick_y h": "at_y up_y -> y",
            f"lift_y {lifter}": "-> up_y",
        },
    )
    found = solved(task, "go_x do_x", "go_y do_y", policy=policy, discount=1)
    assert (found.cost, found.baseline, found.opportunity) == (Fraction(cost), Fraction("5.5"), True)


@pytest.mark.long
@pytest.mark.parametrize(("other", "cost"), [("wander", "5.5"), ("amble", "4.5")])
def test_robots_are_idle_while_a_window_may_be_over(other: str, cost: str) -> None:
    """For x they mend in epoch 1, and the human runs, as they do for y anyway: now x's window is over.

    For y they have to lift after mending, before epoch 4: too late if the human walks for x, too.  Then x
    costs 4 and y 9, or 6 and 5 (where they go for x, that is seen).  To amble comes before walking as a
    string, so it is in the suffix for x, and tells in time: 4 and 5.
    """
    task = build(
        init="can",
        actions={
            "go h": "-> up gone @ 3",
            "run h": "-> up ran",
            "walk h": "up -> walked",
            f"{other} h": "up -> walked",
            "rest h": "walked -> rested",
            "do_x h": "gone rested -> x",
            "neat h": "ran mended rested -> x",
            "do_y h": "ran rested -> y @ 6",
            "quick h": "ran lifted rested -> y",
            "mend r": "can !lifted -> mended !can @ 0",
            "lift r": "-> lifted",
        },
    )
    found = solved(task, "go walk rest do_x", "run walk rest do_y", discount=0)
    assert (found.cost, found.baseline) == (Fraction(cost), Fraction("7.5"))


@pytest.mark.parametrize(("discount", "cost"), [(0, "3.5"), (1, "2")])
def test_the_human_alone_is_no_opportunity(discount: int, cost: str) -> None:
    """Without a detour, which needs no robot, x costs 3 instead of 4, as y does: lifting has to beat 3."""
    task = two_ways(do_x=2, do_y=2)
    found = solved(task, "go_y go_x do_x", "go_y do_y", window_weight=0, discount=discount)
    assert (found.baseline, found.idle[1], found.least[1]) == (Fraction("3.5"), 3, min(3, Fraction(cost)))
    assert (found.cost, found.opportunity) == (Fraction(cost), discount == 1)


@pytest.mark.long
@given(calls(modes=("serendipity",), ties=False))
def test_one_scenario_is_section_3(call: Call) -> None:
    task, options = call.task, call.options.but(max_cost=None)
    plan = call.human_plan or optimal_human_plan(task)
    if not plan or task.robot_goal or max(len(plan), int(options.horizon or 0)) > 4:
        return
    known = best(task, options, plan)
    for policy, risk in (("watching", "mean"), ("fixed", "worst")):
        chosen = options.but(policy=policy, risk=risk)
        found = best_policy(task, chosen, [Scenario(task.goal, plan, Fraction(1))], options.horizon)
        assert (found.cost, found.objective) == (known.cost, known.objective)
        assert (found.opportunity, found.baseline) == (known.opportunity, known.human_cost)
        assert found.baseline - found.idle[1] == known.saving_alone
