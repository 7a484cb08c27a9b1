"""Bounds on moves drop no plan that brute force finds."""

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings

import serendipity
from serendipity.model import Result, Task
from serendipity_testing.strategies import Call, calls
from tests.verify.claims import claim_of
from tests.verify.test_ip_equals_brute_force import check
from verify.calls.solve import solve
from verify.certificate.certify import certify
from verify.limits import limited


@pytest.mark.long
@pytest.mark.parametrize(
    "limits",
    [
        {},
        {"many_actions": 0},
        {"automaton_states": 4, "states_a_value": 0},
        {"weight": 10_000, "methods": ("programs",)},
    ],
    ids=["bounds on moves", "few facts first", "most facts left out", "prices divided for small words"],
)
def test_no_plan_is_dropped(limits: dict[str, Any]) -> None:
    @settings(max_examples=25)
    @given(calls())
    def law(call: Call) -> None:
        with limited(many_moves=0, **limits):
            check(call, method="auto")

    law()


# -- buildings


@pytest.fixture(scope="module")
def building(tmp_path_factory: pytest.TempPathFactory) -> Task:
    folder: Path = tmp_path_factory.mktemp("building")
    serendipity.generate_usar(folder, rooms=84, medkits=3, robots=2, seed=3)
    return serendipity.load(folder)


@pytest.fixture(scope="module")
def answer(building: Task) -> Result:
    return serendipity.plan(building, window_weight=0, discount="0.9")


def test_two_robots_that_hand_on_are_proved_without_a_solver(building: Task, answer: Result) -> None:
    certificate = certify(building, answer, method="pruned")  # no turns, which depend on the clock
    optimal = claim_of(certificate, "optimal")
    assert (optimal.verdict, optimal.solver_calls) == ("proved", 0)
    assert "closed by reachability" in optimal.reason
    assert optimal.method == "program"


@pytest.mark.slow
def test_a_dearer_answer_is_refuted_with_a_plan(building: Task, answer: Result) -> None:
    dearer = serendipity.plan(building, mode="serendipity", discount="0.9")
    assert dearer.cost is not None
    assert answer.cost is not None
    assert answer.cost < dearer.cost
    data = {**dearer.to_dict(), "options": answer.to_dict()["options"]}
    data |= {"objective": dearer.cost, "lower_bound": dearer.cost}
    refuted = serendipity.verify(building, Result.from_dict(data)).refuted
    assert refuted is not None
    assert refuted.claim == "optimal"


@pytest.mark.slow
def test_a_window_of_all_epochs_is_as_good_as_any(building: Task, answer: Result) -> None:
    found = solve(building, answer.options, method="auto")
    assert found.cost == answer.cost
    assert found.window is not None
    assert (found.window.start, found.window.end) == (1, (found.horizon or 0) + 1)
    assert serendipity.check(building, found).verdict == "proved"
