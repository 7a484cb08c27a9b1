"""The exhaustive method answers what brute force answers, and so do turns of it and programs."""

import pytest
from hypothesis import given

from serendipity.model import Options
from serendipity.testing.cases import WORKED, Worked
from serendipity.testing.strategies import Call, calls
from tests.verify.exact_answers import assert_exact, exact_and_solved
from verify.base.execution import conflicting
from verify.calls.solve import solve
from verify.exhaustive import team
from verify.exhaustive.team import excluding

_NOT_ITS_OWN = "the exhaustive method replans suffixes, and preserves kernels"


def _check(call: Call, method: str) -> None:
    both = exact_and_solved(call, method=method)
    if both is None:
        return
    optimum, result = both
    if result.status == "unknown":
        assert method == "exhaustive"
        assert result.reason in (_NOT_ITS_OWN, "a limit on cost, and communication that costs")
        return
    assert_exact(result, optimum, call.options.ties)


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite"])
def test_exhaustive_search_equals_brute_force(mode: str) -> None:
    @given(calls(modes=(mode,)))
    def law(call: Call) -> None:
        _check(call, "exhaustive")

    law()


@given(calls())
def test_turns_equal_brute_force(call: Call) -> None:
    _check(call, "auto")


@given(calls())
def test_what_excludes_each_other_is_what_an_epoch_says(call: Call) -> None:
    task = call.task
    for strict in (False, True):
        apart = excluding(task.actions, len(task.facts), len(task.agents), strict=strict)
        for i, a in enumerate(task.actions):
            for j, b in enumerate(task.actions):
                if i != j:
                    assert bool(apart[i, j]) == conflicting(a, b, strict=strict)


@pytest.mark.parametrize("at_once", [2, 8_192])
@pytest.mark.parametrize("worked", WORKED, ids=str)
def test_worked_cases(worked: Worked, at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(team, "_STATES_AT_ONCE", at_once)
    options = Options(**worked.options)  # type: ignore[arg-type]
    result = solve(worked.task(), options, human_plan=worked.human_plan, method="exhaustive")
    if result.status == "unknown":
        assert result.reason == _NOT_ITS_OWN
        return
    assert result.cost == (None if worked.cost is None else float(worked.cost))
    assert result.opportunity == worked.opportunity
