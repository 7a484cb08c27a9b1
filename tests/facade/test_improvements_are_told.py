"""``plan(on_improvement=...)`` is called with each better answer, and lets out what the callback raises."""

from itertools import pairwise

import pytest

import serendipity
from serendipity import Result, Task


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
