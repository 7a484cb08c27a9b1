"""What a result tells about how it got better: ``Result.gap``."""

import json
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given

from search import PreparedTask, solve
from search.engine import best_first
from serendipity import Result, plan_anytime
from serendipity.model import Options
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.cases import case_2
from serendipity_testing.strategies import Call, calls

FREE: list[dict[str, Any]] = [
    {"mode": "communication", "discount": "0.9"},
    {"mode": "composite", "discount": "0.5", "horizon": "inf"},
]


@pytest.mark.parametrize(
    "options", [*FREE, {"discount": "0.5", "window_weight": 0}, {"human_model": "local"}], ids=str
)
def test_it_ends_with_the_answer(options: dict[str, Any]) -> None:
    """And each answer on the way has what was known by then."""
    answers = list(plan_anytime(case_2(), **options))
    assert len(answers) > 1 or options not in FREE
    for answer in answers:
        assert answer.gap
        assert answer.gap[-1][1:] == (answer.objective, answer.lower_bound)
    result = answers[-1]
    gap = result.gap or ()
    assert [entry.seconds for entry in gap] == sorted(entry.seconds for entry in gap)
    assert gap[-1].seconds <= result.statistics["elapsed_seconds"]
    assert all(before != after for before, after in pairwise(gap))
    assert Result.from_dict(json.loads(json.dumps(result.to_dict()))).gap == gap
    for before, after in pairwise(gap if options in FREE else ()):
        assert None not in (*before, *after)
        assert after.objective <= before.objective
        assert after.lower_bound >= before.lower_bound


@given(calls(modes=("serendipity", "communication", "composite"), ties=False))
def test_reported_bounds_hold(call: Call) -> None:
    """With a report at every node, no bound is above the optimum, and none falls."""
    options = replace(call.options, time_limit=None)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(best_first.Progress, "due", lambda *_: True)
        outcomes = list(
            solve(PreparedTask(call.task), options, human_plan=call.human_plan, deadline=Deadline())
        )
    last = outcomes[-1]
    bounds = [o.lower_bound for o in outcomes if o.lower_bound is not None]
    if last.status == "optimal":
        assert last.objective is not None
        assert all(bound <= last.objective for bound in bounds)
    if not options.windowed:
        assert bounds == sorted(bounds)


def test_bounds_are_reported_while_no_better_plan_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search that proves its first answer by raising the bound tells so on the way."""
    options = Options(mode="communication", discount="0.9")  # type: ignore[arg-type]
    quiet = list(solve(PreparedTask(case_2()), options))
    monkeypatch.setattr(best_first.Progress, "due", lambda *_: True)
    told = list(solve(PreparedTask(case_2()), options))
    assert len(told) > len(quiet)
    assert (told[-1].cost, told[-1].status) == (quiet[-1].cost, quiet[-1].status)
