"""``plan_anytime``: objectives never rise but where the first window begins to count, bounds never fall."""

from itertools import pairwise
from typing import Any

import pytest

import serendipity
from serendipity import Result, UsageError
from serendipity.facade import one_plan
from serendipity.model import Deadline
from serendipity.testing.generator.calls import random_call

CALLS = 150


def better_or_closer(before: Result, after: Result) -> bool:
    """Whether an answer is as good as the one before it, and known at least as well."""
    assert before.objective is not None and after.objective is not None
    assert before.lower_bound is not None and after.lower_bound is not None
    assert before.cost is not None and after.cost is not None
    if before.window is None and after.window is not None:
        return after.cost < before.cost and after.lower_bound >= before.lower_bound
    return after.objective <= before.objective and after.lower_bound >= before.lower_bound


def test_answers_to_random_calls_get_better() -> None:
    improved = opened = 0
    for seed in range(CALLS):
        call = random_call(seed)
        try:
            given = serendipity.plan_anytime(call.task, human_plan=call.human_plan, **call.keywords())
            answers = [answer for answer in given if answer.plan is not None]
        except UsageError:
            continue  # a call that has to name a horizon
        for before, after in pairwise(answers):
            assert better_or_closer(before, after), f"seed {seed}"
            improved += before.cost != after.cost
            opened += before.window is None and after.window is not None
    assert improved >= 20 and opened >= 10


def test_verdicts_on_the_way_take_little_of_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[float | None] = []

    def looked_at(*_: object, deadline: Deadline, **__: object) -> dict[str, bool]:
        left.append(deadline.left())
        return {}

    monkeypatch.setattr(one_plan, "realised", looked_at)
    *_, last = serendipity.plan_anytime(serendipity.example("room2"), discount=0.6, time_limit=50)
    assert last.status == "optimal"
    *before, at_the_end = (seconds for seconds in left if seconds is not None)
    assert before and all(seconds <= 1 for seconds in before) and at_the_end > 10


def test_the_last_answer_has_the_verdicts_that_plan_gives() -> None:
    options: dict[str, Any] = {"discount": 0.6, "time_limit": 50}
    *_, last = serendipity.plan_anytime(serendipity.example("room2"), **options)
    assert last.realised == serendipity.plan(serendipity.example("room2"), **options).realised != {}
