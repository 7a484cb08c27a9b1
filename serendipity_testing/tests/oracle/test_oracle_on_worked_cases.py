"""The brute-force oracle gives the figures of semantics 9."""

from fractions import Fraction

import pytest

from serendipity.model import Options, Task, Window
from serendipity_testing.cases import (
    CASE_3_PLAN,
    WORKED,
    Worked,
    case_2,
    case_3,
    case_4,
    case_7,
    case_8,
    case_9,
    case_10,
)
from serendipity_testing.oracle import action_sets, best, human_plans, optimal_human_plan

QUICK = (case_2, case_8, case_9, case_10)


@pytest.mark.parametrize(
    "worked", [pytest.param(w, marks=() if w.task in QUICK else pytest.mark.slow, id=str(w)) for w in WORKED]
)
def test_worked_case(worked: Worked) -> None:
    task = worked.task()
    plan = None if worked.human_plan is None else task.plan_from_names(worked.human_plan)
    optimum = best(task, Options(**worked.options), plan)  # type: ignore[arg-type]
    assert optimum.cost == (None if worked.cost is None else Fraction(worked.cost))
    assert optimum.window == (None if worked.window is None else Window(*worked.window))
    assert optimum.opportunity == worked.opportunity
    assert (optimum.status == "infeasible") == (worked.cost is None)


def test_case_3_has_two_optimal_plans_of_7_steps() -> None:
    task = case_3()
    plans = list(human_plans(task))
    assert task.plan_from_names(CASE_3_PLAN) in plans
    assert {len(plan) for plan in plans} == {7}


@pytest.mark.long
def test_case_4_canonical_plan_goes_by_r() -> None:
    task = case_4()
    assert len(list(human_plans(task))) == 2
    canonical = optimal_human_plan(task)
    assert "move h c r" in [task.actions[i].name for i in canonical]


@pytest.mark.slow
def test_case_4_expected_is_the_mean_over_his_plans() -> None:
    task = case_4()
    expected = best(task, Options(discount="0.9", ties="expected"))  # type: ignore[arg-type]
    assert expected.cost == Fraction("7.1")


def _allowed(task: Task, *names: str) -> bool:
    sets = action_sets(task, task.init, range(len(task.actions)))
    return {*names} in [{task.actions[i].name for i in chosen} for chosen in sets]


def test_case_7_which_actions_share_an_epoch() -> None:
    task = case_7()
    human, robot = "pick_up_medkit h {} a", "pick_up_medkit rob {} a"
    assert _allowed(task, human.format("k1"))
    assert not _allowed(task, human.format("k1"), robot.format("k1"))
    assert not _allowed(task, human.format("k1"), robot.format("k2"))
    assert _allowed(task, "move h a b", robot.format("k1"))
    held = case_7(first_kit="@h")
    drop, hand = "drop_off h k1 a", "hand_over h rob k1 a"
    assert _allowed(held, drop)
    assert _allowed(held, hand)
    assert not _allowed(held, drop, robot.format("k2"))
    assert not _allowed(held, hand, robot.format("k2"))
    assert not _allowed(held, hand, "move rob a b")
    assert not _allowed(held, hand, "move h a b")
