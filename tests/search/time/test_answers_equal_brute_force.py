"""Answers where actions take time, the human waits, or something happens anyway: those of brute force."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity.model.keywords import Ties
from serendipity_testing.call import Call
from serendipity_testing.strategies.time import calls_in_time
from tests.search.exact_answers import assert_answered


@pytest.mark.long
@given(calls_in_time())
def test_answers_are_those_of_brute_force(call: Call) -> None:
    assert_answered(call)


@pytest.mark.long
@given(
    calls_in_time(modes=("serendipity", "communication")),
    st.sampled_from(["robust", "optimistic", "expected"]),
)
def test_answers_over_ties_are_those_of_brute_force(call: Call, ties: Ties) -> None:
    assert_answered(replace(call, options=call.options.but(ties=ties), human_plan=None))
