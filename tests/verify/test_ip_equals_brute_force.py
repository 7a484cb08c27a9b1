"""Both encodings answer what brute force answers, on random small calls with every option."""

from fractions import Fraction

import pytest
from hypothesis import given, settings

from serendipity.model import Options, Result, UsageError
from serendipity.testing.cases import WORKED, Worked
from serendipity.testing.oracle import Optimum, best
from serendipity.testing.strategies import Call, calls
from verify.calls.solve import solve


def _assert_equal(result: Result, optimum: Optimum, ties: str) -> None:
    assert result.status == optimum.status
    assert result.cost == _rounded(optimum.cost)
    if ties == "expected" or optimum.cost is None:
        return
    assert result.opportunity == optimum.opportunity
    assert result.objective == result.lower_bound == _rounded(optimum.objective)
    assert result.saving == _rounded(optimum.saving)
    if optimum.saving_alone is not None:
        assert result.saving_alone == _rounded(optimum.saving_alone)


def _rounded(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


def _check(call: Call, **settings: str) -> None:
    try:
        optimum = best(call.task, call.options, call.human_plan)
    except UsageError:
        with pytest.raises(UsageError):
            solve(call.task, call.options, human_plan=call.human_plan_names, **settings)
        return
    result = solve(call.task, call.options, human_plan=call.human_plan_names, **settings)
    _assert_equal(result, optimum, call.options.ties)


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite", "individual"])
def test_automata_equal_brute_force(mode: str) -> None:
    @given(calls(modes=(mode,)))
    def law(call: Call) -> None:
        _check(call, encoding="automata")

    law()


@pytest.mark.parametrize("mode", ["serendipity", "communication"])
def test_the_papers_equations_equal_brute_force(mode: str) -> None:
    @settings(max_examples=50)
    @given(calls(modes=(mode,), ties=False))
    def law(call: Call) -> None:
        _check(call, encoding="paper")

    law()


@settings(max_examples=20)
@given(calls(modes=("serendipity", "communication"), ties=False))
def test_cbc_equals_brute_force(call: Call) -> None:
    _check(call, solver="cbc")


@pytest.mark.parametrize("worked", WORKED, ids=str)
def test_worked_cases(worked: Worked) -> None:
    result = solve(worked.task(), Options(**worked.options), human_plan=worked.human_plan)  # type: ignore[arg-type]
    assert result.cost == (None if worked.cost is None else float(worked.cost))
    assert result.opportunity == worked.opportunity
