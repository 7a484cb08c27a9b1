"""The verdicts that semantics 9 and semantics 6 state about humans who replan."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import pytest

import serendipity
from serendipity import Task
from serendipity_testing.cases import case_1, case_2, case_4, case_8
from tests.search.modes.simulation.test_planning_for_humans import _everything
from verify.certificate.simulator import realised_claim

HELPED = [
    # case, discount, promised, realised by an observant human
    (case_1, 0.6, 9.6, True),
    (case_1, 0.9, 8.4, True),
    (case_2, 0.5, 8.5, False),
    (case_4, 0.9, 6.2, False),
]


@pytest.mark.parametrize(("case", "discount", "cost", "realised"), HELPED)
def test_verdict_of_the_paper_s_answer(
    case: Callable[[], Task], discount: float, cost: float, realised: bool
) -> None:
    task = case()
    result = serendipity.plan(task, discount=discount)
    assert result.cost == cost
    assert result.realised == {"observant": realised}
    assert serendipity.simulate(task, result).realised is realised
    claim = realised_claim(task, result)
    assert claim.verdict == "proved"


OPTIMA = [
    # case, discount, robots may block the human, the best that happens
    (case_1, 0.9, False, 8.4),
    (case_2, 0.5, False, 9.0),
    (case_2, 0.5, True, 7.0),
    (case_4, 0.9, False, 8.0),
]


@pytest.mark.parametrize(("case", "discount", "block", "cost"), OPTIMA)
def test_observant_optimum(case: Callable[[], Task], discount: float, block: bool, cost: float) -> None:
    task = case()
    result = serendipity.plan(task, discount=discount, human_model="observant", no_block=not block)
    assert result.status == "optimal"
    assert result.cost == result.objective == result.lower_bound == cost
    assert result.human_cost is not None
    assert result.opportunity == (cost < result.human_cost)
    assert result.window is None
    assert result.realised == {"observant": True}
    assert serendipity.check(task, result).verdict == "proved"


def test_case_2_a_blocked_human_waits() -> None:
    trace = serendipity.simulate(case_2(), serendipity.plan(case_2(), discount=0.5))
    assert [epoch.epoch for epoch in trace.epochs if epoch.decision == "waits"] == [3, 4, 5]
    assert trace.epochs[3].skipped[0].why == "inapplicable"


def test_case_4_he_turns_to_the_other_kit() -> None:
    trace = serendipity.simulate(case_4(), serendipity.plan(case_4(), discount=0.9))
    second = trace.epochs[1]
    assert "not at k2 r" in second.saw
    assert second.expected_cost is None
    assert second.best_cost == 7
    assert second.did == "move h b s"
    assert trace.cost == 8.2


def test_room5_nobody_told_him() -> None:
    """The human walks into room5 in the very epoch in which the robot drops the kit in hall4."""
    task = serendipity.example("room5")
    result = serendipity.plan(task, discount=0.9)
    trace = serendipity.simulate(task, result)
    assert result.cost == 11.5
    assert not trace.realised
    assert trace.epochs[4].did == "move_reverse commx hall5 room5"
    assert trace.cost == 13.5


@pytest.mark.parametrize("model", ["observant", "local"])
def test_whoever_has_no_plan_accepts_help(model: str) -> None:
    result = serendipity.plan(case_8(), mode="composite")
    trace = serendipity.simulate(case_8(), result, model)
    assert trace.realised
    assert trace.epochs[0].decision == "waits"
    assert trace.epochs[0].did == "hand_over rob h k a"


def test_what_is_visible_can_be_replaced() -> None:
    result = serendipity.plan(case_4(), discount=0.9)
    trace = serendipity.simulate(case_4(), result, "local", visible=_everything)
    assert trace.cost == serendipity.simulate(case_4(), result).cost == float(Fraction("8.2"))


def test_a_doctored_verdict_and_an_answer_that_he_does_not_produce_are_refuted() -> None:
    task = case_4()
    told = serendipity.plan(task, discount=0.9)
    lie = replace(told, options=told.options.but(human_model="observant"), realised={})
    for wrong in (replace(told, realised={"observant": True}), lie):
        assert realised_claim(task, wrong).verdict == "refuted"
