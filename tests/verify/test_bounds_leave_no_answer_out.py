"""A lower bound holds for every answer: with help and a window, without, and beside robots' own goals."""

from dataclasses import replace
from typing import Any

import pytest

import serendipity
from serendipity.model import Result, Task
from serendipity_testing.builders import task as build
from serendipity_testing.by_hand import result
from serendipity_testing.cases import case_4
from serendipity_testing.countdown import Countdown
from serendipity_testing.crosscheck.doctored import without_plan
from serendipity_testing.generator import random_call
from tests.verify.valid import CASE_4_PI_H

METHODS = ["auto", "exhaustive", "program"]


def _verdict(task: Task, answer: Result, method: str) -> str:
    return serendipity.verify(task, answer, method=method).verdict  # type: ignore[arg-type]


@pytest.mark.long
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("ties", ["fixed", "optimistic", "robust", "expected"])
def test_bounds_without_help_are_net_of_its_window(ties: str, method: str) -> None:
    """Help costs 6.2 in one epoch beside one plan of the human's, so no bound above 6.2 holds without K."""
    task, options = case_4(), {"discount": "0.9", "ties": ties}
    right = serendipity.plan(task, **options)
    idle = result(task, dict(enumerate(CASE_4_PI_H, start=1)), human_plan=CASE_4_PI_H, **options)
    least = {"expected": 7.1}.get(ties, 6.2)
    for bound, verdict in ((least, "proved"), (least + 1e-9, "refuted")):
        given = replace(idle, status="feasible", lower_bound=bound, ties=right.ties and _idle(right))
        if ties == "expected":
            given = replace(given, plan=None, agent_costs={})
        found = _verdict(task, given, method)
        assert found in (verdict, "undecided"), bound


def _idle(right: Result) -> Any:
    return tuple(replace(tie, cost=right.human_cost, opportunity=False) for tie in right.ties or ())


@pytest.mark.parametrize("method", METHODS)
def test_robots_that_see_to_their_own_goals_are_an_answer(method: str) -> None:
    """They pay 2 for their own goal, which no window opens for: the human has nothing to do."""
    task = build(goal="!p", robot_goal="q", actions={"do h": "-> p", "set r": "-> q @ 2"})
    right = serendipity.plan(task, horizon=1)
    assert (right.status, right.cost, right.window) == ("optimal", 2.0, None)
    for bound, verdict in ((2.0, "proved"), (2.5, "refuted")):
        assert _verdict(task, without_plan(right, "unknown", "time-limit", bound), method) == verdict


@pytest.mark.long
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("ties", ["optimistic", "robust", "expected"])
def test_bounds_of_what_is_unknown_hold_whichever_optimal_plan_the_human_is_on(
    ties: str, method: str
) -> None:
    """Beside one optimal plan help costs 6.2, beside the other nothing helps: 8."""
    task = case_4()
    least = {"expected": 7.1}.get(ties, 6.2)
    for human_plan in {
        tie.human_plan for tie in serendipity.plan(task, discount="0.9", ties=ties).ties or ()
    }:
        given = result(
            task, dict(enumerate(human_plan, start=1)), human_plan=human_plan, discount="0.9", ties=ties
        )
        for bound, verdict in ((least, "proved"), (least + 0.5, "refuted")):
            early = without_plan(given, "unknown", "time-limit", bound)
            assert _verdict(task, early, method) in (verdict, "undecided")


def test_who_replans_has_no_window_that_bounds_are_net_of() -> None:
    task, seen = random_call(7802).task, set()
    for looks in range(200):
        options = {"discount": "0.9", "ties": "expected", "human_model": "local"}
        try:
            early = serendipity.plan(task, deadline=Countdown(looks), **options)
        except serendipity.LimitReachedError:
            continue
        if early.lower_bound not in seen:
            seen.add(early.lower_bound)
            assert _verdict(task, early, "auto") != "refuted", early
    assert len(seen) > 2
