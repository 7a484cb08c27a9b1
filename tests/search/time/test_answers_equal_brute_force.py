"""Answers where actions take time, the human waits, or something happens anyway: those of brute force."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import PlanError, UsageError
from serendipity.model.keywords import Ties
from serendipity.testing.call import Call
from serendipity.testing.oracle import best
from serendipity.testing.strategies.time import calls_in_time


def answered(call: Call) -> tuple[object, ...]:
    """Status and figures, or that the call is refused."""
    try:
        found = serendipity.plan(call.task, human_plan=call.human_entries, **call.keywords())
    except (UsageError, PlanError):
        return ("refused",)
    return found.status, found.cost, found.objective, found.window, found.opportunity


def expected(call: Call) -> tuple[object, ...]:
    try:
        found = best(call.task, call.options, call.human_plan)
    except (UsageError, PlanError):
        return ("refused",)
    figures = (None if figure is None else float(figure) for figure in (found.cost, found.objective))
    return (found.status, *figures, found.window, found.opportunity)


@pytest.mark.long
@given(calls_in_time())
def test_answers_are_those_of_brute_force(call: Call) -> None:
    assert answered(call) == expected(call)


@pytest.mark.long
@given(
    calls_in_time(modes=("serendipity", "communication")),
    st.sampled_from(["robust", "optimistic", "expected"]),
)
def test_answers_over_ties_are_those_of_brute_force(call: Call, ties: Ties) -> None:
    over = replace(call, options=call.options.but(ties=ties), human_plan=None)
    assert answered(over) == expected(over)
