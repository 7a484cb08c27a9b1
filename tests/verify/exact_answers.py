"""What the verifier solves by itself, held against brute force."""

from fractions import Fraction

import pytest

from serendipity.model import Result, UsageError
from serendipity.testing.oracle import Optimum, best
from serendipity.testing.strategies import Call
from verify.calls.solve import solve


def exact_and_solved(call: Call, **settings: str) -> tuple[Optimum, Result] | None:
    """The optimum and the verifier's answer; None where both refuse the call."""
    try:
        optimum = best(call.task, call.options, call.human_plan)
    except UsageError:
        with pytest.raises(UsageError):
            solve(call.task, call.options, human_plan=call.human_plan_names, **settings)
        return None
    return optimum, solve(call.task, call.options, human_plan=call.human_plan_names, **settings)


def assert_exact(result: Result, optimum: Optimum, ties: str) -> None:
    """Every figure of an answer is the optimum's; means over ties have a cost only."""
    assert result.status == optimum.status
    assert result.cost == rounded(optimum.cost)
    if ties == "expected" or optimum.cost is None:
        return
    assert result.opportunity == optimum.opportunity
    assert result.objective == result.lower_bound == rounded(optimum.objective)
    assert result.saving == rounded(optimum.saving)
    if optimum.saving_alone is not None:
        assert result.saving_alone == rounded(optimum.saving_alone)


def rounded(value: Fraction | None) -> float | None:
    """A figure as results have it."""
    return None if value is None else float(value)
