"""The exhaustive method answers what brute force answers, and so do turns of it and programs."""

import pytest
from hypothesis import given

from serendipity.model import Options
from serendipity_testing.cases import WORKED, Worked
from serendipity_testing.strategies import Call, calls, oddly_priced_tasks, tasks
from tests.verify.test_ip_equals_brute_force import check
from verify.base.execution import conflicting
from verify.calls.solve import solve
from verify.exhaustive.team import excluding
from verify.limits import limited


@pytest.mark.long
@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite"])
def test_exhaustive_search_equals_brute_force(mode: str) -> None:
    @given(calls(modes=(mode,), of=tasks() | oddly_priced_tasks()))
    def law(call: Call) -> None:
        check(call, method="exhaustive")

    law()


@pytest.mark.long
@given(calls())
def test_turns_equal_brute_force(call: Call) -> None:
    check(call, method="auto")


@given(calls())
def test_what_excludes_each_other_is_what_an_epoch_says(call: Call) -> None:
    task = call.task
    for strict in (False, True):
        apart = excluding(task.actions, len(task.facts), len(task.agents), strict=strict)
        for i, a in enumerate(task.actions):
            for j, b in enumerate(task.actions):
                if i != j:
                    assert bool(apart[i, j]) == conflicting(a, b, strict=strict)


@pytest.mark.long
@pytest.mark.parametrize(("method", "at_once"), [("exhaustive", 2), ("exhaustive", 8_192), ("program", 1)])
@pytest.mark.parametrize("worked", WORKED, ids=str)
def test_worked_cases(worked: Worked, method: str, at_once: int) -> None:
    options = Options(**worked.options)  # type: ignore[arg-type]
    with limited(states_at_once=at_once):
        result = solve(worked.task(), options, human_plan=worked.human_plan, method=method)
    assert result.cost == (None if worked.cost is None else float(worked.cost))
    assert result.opportunity == worked.opportunity
