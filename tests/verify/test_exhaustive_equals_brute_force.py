"""The exhaustive method answers what brute force answers, and so do turns of it and programs."""

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis.strategies import SearchStrategy

from serendipity.model import Options, Task
from serendipity.testing.cases import WORKED, Worked
from serendipity.testing.strategies import Call, calls, oddly_priced_tasks, tasks
from tests.verify.exact_answers import assert_exact, exact_and_solved
from verify.base.execution import conflicting
from verify.calls.solve import solve
from verify.exhaustive.team import excluding
from verify.limits import limited

_TOO_LARGE = "the task is too large for the exhaustive method"


def _check(call: Call, method: str) -> None:
    both = exact_and_solved(call, method=method)
    if both is None:
        return
    optimum, result = both
    if result.status == "unknown":
        assert method == "exhaustive"
        assert result.reason == _TOO_LARGE
        return
    assert_exact(result, optimum, call.options.ties)


@pytest.mark.parametrize("of", [tasks, oddly_priced_tasks])
@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite"])
def test_exhaustive_search_equals_brute_force(mode: str, of: Callable[[], SearchStrategy[Task]]) -> None:
    @given(calls(modes=(mode,), of=of()))
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
def test_worked_cases(worked: Worked, at_once: int) -> None:
    options = Options(**worked.options)  # type: ignore[arg-type]
    with limited(states_at_once=at_once):
        result = solve(worked.task(), options, human_plan=worked.human_plan, method="exhaustive")
    assert result.cost == (None if worked.cost is None else float(worked.cost))
    assert result.opportunity == worked.opportunity
