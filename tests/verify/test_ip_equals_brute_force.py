"""Both encodings answer what brute force answers, on random small calls with every option."""

from fractions import Fraction

import pytest
from hypothesis import given, settings

from serendipity.model import UsageError
from serendipity_testing.oracle import best
from serendipity_testing.strategies import Call, calls
from verify.calls.solve import solve


def check(call: Call, **how: str) -> None:
    """Assert that every figure is the optimum's, or that both refuse the call; means have a cost only."""
    try:
        optimum = best(call.task, call.options, call.human_plan)
    except UsageError:
        with pytest.raises(UsageError):
            solve(call.task, call.options, human_plan=call.human_plan_names, **how)
        return
    result = solve(call.task, call.options, human_plan=call.human_plan_names, **how)
    if how == {"method": "exhaustive"} and result.status == "unknown":
        assert result.reason == "the task is too large for the exhaustive method"
        return
    assert (result.status, result.cost) == (optimum.status, _rounded(optimum.cost))
    if call.options.ties == "expected" or optimum.cost is None:
        return
    assert result.opportunity == optimum.opportunity
    assert result.objective == result.lower_bound == _rounded(optimum.objective)
    assert result.saving == _rounded(optimum.saving)
    assert optimum.saving_alone is None or result.saving_alone == _rounded(optimum.saving_alone)


def _rounded(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


@pytest.mark.long
@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite", "individual"])
def test_automata_equal_brute_force(mode: str) -> None:
    @given(calls(modes=(mode,)))
    def law(call: Call) -> None:
        check(call, encoding="automata")

    law()


@pytest.mark.long
@pytest.mark.parametrize("mode", ["serendipity", "communication"])
def test_the_papers_equations_equal_brute_force(mode: str) -> None:
    @settings(max_examples=50)
    @given(calls(modes=(mode,), ties=False))
    def law(call: Call) -> None:
        check(call, encoding="paper")

    law()


@settings(max_examples=20)
@given(calls(modes=("serendipity", "communication"), ties=False))
def test_cbc_equals_brute_force(call: Call) -> None:
    check(call, solver="cbc")
