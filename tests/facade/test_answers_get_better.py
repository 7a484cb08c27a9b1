"""Answers on the way: objectives never rise but where the first window begins to count, bounds never fall.

``plan_anytime`` gives them all; ``plan(on_improvement=...)`` is called with each that is better.
"""

from itertools import pairwise
from typing import Any

import pytest

import serendipity
from serendipity import Result, Task, UsageError
from serendipity.facade import one_plan
from serendipity.model import Deadline
from serendipity_testing.generator.calls import random_call

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


@pytest.fixture(scope="module")
def task() -> Task:
    return serendipity.example("room2")


@pytest.mark.parametrize("mode", ["serendipity", "composite", "communication", "individual", "assistance"])
def test_each_better_answer_is_told_and_the_last_is_the_answer(task: Task, mode: str) -> None:
    told: list[Result] = []
    answer = serendipity.plan(task, mode=mode, discount=0.6, on_improvement=told.append)
    reached = [(result.objective, result.cost) for result in told]
    assert reached and all(before != after for before, after in pairwise(reached))
    assert told[-1].objective == answer.objective and told[-1].cost == answer.cost
    assert answer.status == "optimal" and answer.cost == serendipity.plan(task, mode=mode, discount=0.6).cost


def test_those_told_are_the_better_ones_of_plan_anytime(task: Task) -> None:
    told: list[Result] = []
    serendipity.plan(task, discount=0.6, on_improvement=told.append)
    answers = [(r.objective, r.cost, r.window) for r in serendipity.plan_anytime(task, discount=0.6)]
    assert [(r.objective, r.cost, r.window) for r in told] == list(dict.fromkeys(answers))
    assert [r.cost for r in told] == [13.0, 12.6] and told[0].status == "feasible"


def test_goals_that_are_not_known_and_sessions_tell_too(task: Task) -> None:
    told: list[Result] = []
    goals = [{"goal": [f"conducted_triage commx {room}"], "prior": 1} for room in ("room1", "room2")]
    expected = serendipity.plan(task, discount=0.6, goals=goals, on_improvement=told.append)
    assert told[-1].objective == expected.objective
    session = serendipity.Session(task, discount=0.6)
    answer = session.plan(on_improvement=told.append)
    assert told[-1].cost == answer.cost


def test_what_the_callback_raises_ends_the_call(task: Task) -> None:
    told: list[Result] = []

    def enough(result: Result) -> None:
        told.append(result)
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        serendipity.plan(task, discount=0.6, on_improvement=enough)
    assert len(told) == 1
    assert serendipity.plan(task, discount=0.6).cost == 12.6


def test_where_there_is_no_answer_nothing_is_told(task: Task) -> None:
    told: list[Result] = []
    answer = serendipity.plan(task, discount=0.6, time_limit=0, on_improvement=told.append)
    assert [result.cost for result in told] == ([] if answer.cost is None else [answer.cost])
