"""Help that leaves a person in peace (semantics 13): as brute force has it, and proved; and the front."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from serendipity import Options, Task, UsageError
from serendipity.facade.front import drawn
from serendipity.testing.oracle import best
from tests.facade.rooms import answered, rooms

_OPTIONS = st.builds(
    Options,
    mode=st.sampled_from(["serendipity", "serendipity", "communication", "composite"]),
    discount=st.sampled_from(["0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["0", "0.25", "1000"]),
    suffix=st.sampled_from(["replan", "subplan"]),
    interference=st.sampled_from(["paper", "strict"]),
    disturbance=st.sampled_from([None, "ask=2", "sight=1", "meet=1, ask=0.5"]),
    max_disturbance=st.sampled_from([0, "0.5", 1, 3]),
    leave_free=st.sampled_from([None, None, "at *"]),
)


@pytest.mark.long
@given(rooms(), _OPTIONS)
@settings(max_examples=60)
def test_answers_are_those_of_brute_force(task: Task, options: Options) -> None:
    expected = best(task, options)
    answer = answered(task, options)
    figures = (answer.status, answer.cost, answer.objective, answer.opportunity)
    assert expected.cost is not None and expected.objective is not None
    found = (expected.status, float(expected.cost), float(expected.objective), expected.opportunity)
    assert figures == found
    assert (answer.figure("disturbance") or 0) <= float(options.max_disturbance or 0)
    assert serendipity.verify(task, answer).verdict == "proved"


def test_a_plan_that_disturbs_more_than_it_may_is_refuted() -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.9", max_disturbance=1)
    assert answer.figure("disturbance") == 1
    told = replace(answer, options=answer.options.but(max_disturbance=0))
    for certificate in (serendipity.verify(task, told), serendipity.check(task, told)):
        assert "help disturbs the human by 1, and may by 0" in str(certificate)


@pytest.mark.parametrize(
    "name", ["room2", "room7", pytest.param("flights", marks=pytest.mark.long), "parcels", "office"]
)
def test_each_point_of_a_front_is_proved_and_none_dominated(name: str) -> None:
    task, options = serendipity.example(name), {"discount": "0.9", "window_weight": 0}
    front = serendipity.front(task, discount="0.9", verify=True)
    assert front.complete
    assert all(point.certificate and point.certificate.verdict == "proved" for point in front.points)
    assert all(a.disturbance < b.disturbance and a.saving < b.saving for a, b in pairwise(front.points))
    assert front.points[-1].result.cost == serendipity.plan(task, **options).cost
    assert front.points[0].result.cost == serendipity.plan(task, max_disturbance=0, **options).cost
    assert drawn(front, ".svg").count("<circle") == len(front.points)


def test_each_point_of_a_front_over_goals_is_proved() -> None:
    """What disturbs is the most of either goal; each end is what the single calls say."""
    task, options = serendipity.example("room2"), {"discount": "0.9", "window_weight": 0}
    goals = [
        {"name": "triage", "goal": ["conducted_triage commx room1"]},
        {"name": "home", "goal": ["at commx hall1"]},
    ]
    front = serendipity.front(task, goals=goals, discount="0.9", verify=True)
    assert front.complete and len(front.points) > 1
    assert all(point.certificate and point.certificate.verdict == "proved" for point in front.points)
    assert all(a.disturbance < b.disturbance and a.saving < b.saving for a, b in pairwise(front.points))
    ends = {0: {"max_disturbance": 0}, -1: {}}
    for at, most in ends.items():
        assert front.points[at].result.cost == serendipity.plan(task, goals=goals, **options, **most).cost


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"max_disturbance": -1}, "max_disturbance: expected a number of at least 0, got -1"),
        ({"max_disturbance": 1, "mode": "assistance"}, "max_disturbance: is not known of mode 'assistance'"),
        ({"disturbance": "ask=x"}, "disturbance: ask: "),
    ],
)
def test_what_is_no_disturbance_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        serendipity.plan(serendipity.example("room2"), **options)
