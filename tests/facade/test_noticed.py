"""Help that the human notices before they act on it (semantics 14): as brute force has it, and proved."""

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity import Options, Task, UsageError
from serendipity.testing import strategies
from serendipity.testing.oracle import best
from tests.facade.rooms import rooms

_OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["0", "0.25", "1000"]),
    noticed=st.just(True),
    leave_free=st.sampled_from([None, None, "at *"]),
)


@pytest.mark.long
@given(st.one_of(rooms(timed=False), strategies.tasks()), _OPTIONS)
def test_answers_are_those_of_brute_force(task: Task, options: Options) -> None:
    expected = best(task, options)
    answer = serendipity.plan(task, **{name: getattr(options, name) for name in options.to_dict()})
    figures = (answer.status, answer.cost, answer.objective, answer.opportunity)
    if expected.cost is None or expected.objective is None:
        assert answer.status == expected.status
        return
    found = (expected.status, float(expected.cost), float(expected.objective), expected.opportunity)
    assert figures == found
    assert serendipity.verify(task, answer).verdict == "proved"


def test_they_do_not_go_for_what_is_brought_elsewhere_at_that_moment() -> None:
    """In ``room5`` they pass by room5 in the epoch in which the robot drops the medkit elsewhere."""
    task = serendipity.example("room5")
    free = serendipity.plan(task, discount="0.9")
    bound = serendipity.plan(task, discount="0.9", noticed=True)
    assert (free.cost, bound.cost, bound.figure("rule_price")) == (11.5, 13, 1.5)
    told = replace(free, options=free.options.but(noticed=True))
    for certificate in (serendipity.verify(task, told), serendipity.check(task, told)):
        assert "noticed (semantics 14): the human has not seen" in str(certificate)


def test_what_is_handed_over_needs_no_notice() -> None:
    answer = serendipity.plan(serendipity.example("room2"), discount="0.9", noticed=True)
    assert (answer.cost, answer.statistics["rule_binds"]) == (11.4, False)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"mode": "composite"}, "noticed: goes with mode serendipity only"),
        ({"suffix": "subplan"}, "noticed: goes with suffix replan only"),
        ({"interference": "strict"}, "noticed: does not go with interference strict"),
        ({"head_start": 3}, "noticed: waiting_cost and head_start are given, which is not known here yet"),
    ],
)
def test_what_it_does_not_go_with_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        serendipity.plan(serendipity.example("room2"), noticed=True, **options)
