"""The search answers what brute force answers, on random small tasks, in every mode and option."""

from collections.abc import Callable
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis.strategies import SearchStrategy

import serendipity
from serendipity import Result, Task, UsageError
from serendipity.testing.oracle import Optimum, best
from serendipity.testing.strategies import Call, calls, family_tasks, tasks


def _answer(call: Call) -> Result | str:
    return _or_error(lambda: serendipity.plan(call.task, human_plan=call.human_plan_names, **call.keywords()))


def _or_error(compute: Callable[[], Result]) -> Result | str:
    try:
        return compute()
    except UsageError as error:
        return str(error).split(":")[0]


def _expected(call: Call) -> Optimum | str:
    try:
        return best(call.task, call.options, call.human_plan)
    except UsageError as error:
        return str(error).split(":")[0]


def _assert_equal(result: Result, optimum: Optimum, call: Call) -> None:
    assert result.status == optimum.status
    assert _exact(result.cost) == _rounded(optimum.cost)
    assert result.opportunity == optimum.opportunity or call.options.ties == "expected"
    if call.options.ties == "expected" or optimum.cost is None:
        return
    assert _exact(result.objective) == _rounded(optimum.objective)
    assert result.window == optimum.window
    assert _exact(result.saving) == _rounded(optimum.saving)
    if optimum.saving_alone is not None:
        assert _exact(result.saving_alone) == _rounded(optimum.saving_alone)
    assert result.plan is not None
    assert len(result.plan) == optimum.actions
    assert result.lower_bound == result.objective


def _exact(value: float | None) -> Fraction | None:
    return None if value is None else Fraction(str(value))


def _rounded(value: Fraction | None) -> Fraction | None:
    return None if value is None else Fraction(str(float(value)))


@pytest.mark.parametrize("of", [tasks, family_tasks])
@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite", "individual"])
def test_search_equals_brute_force(mode: str, of: Callable[[], SearchStrategy[Task]]) -> None:
    @given(calls(modes=(mode,), of=of()))
    def law(call: Call) -> None:
        result, optimum = _answer(call), _expected(call)
        if isinstance(result, str) or isinstance(optimum, str):
            assert result == optimum
        else:
            _assert_equal(result, optimum, call)

    law()
