"""Both encodings answer what brute force answers, on random small calls with every option."""

import pytest
from hypothesis import given, settings

from serendipity.model import Options
from serendipity.testing.cases import WORKED, Worked
from serendipity.testing.strategies import Call, calls
from tests.verify.exact_answers import assert_exact, exact_and_solved
from verify.calls.solve import solve


def _check(call: Call, **settings: str) -> None:
    both = exact_and_solved(call, **settings)
    if both is not None:
        optimum, result = both
        assert_exact(result, optimum, call.options.ties)


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
