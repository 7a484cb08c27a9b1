"""Each strategy alone, and the portfolio without each: never a wrong claim, and the same optimum."""

from dataclasses import replace
from functools import cache
from random import Random
from typing import Any

import pytest

import serendipity
from search.call.prepared_task import PreparedTask
from search.kernel.library import library
from search.strategies.portfolio import STRATEGIES, TURNS, chosen, solve
from serendipity import Result, Task, UsageError
from serendipity.model import Options
from serendipity_testing.builders import usar
from serendipity_testing.generator.families import AGENTS, FAMILIES, SMALL

NAMES = list(dict.fromkeys([*STRATEGIES, *(turn.name for turn in TURNS)]))
"""Strategies, and single turns of theirs."""

BEGUN_BY_OTHERS = {"warm-start", "alone", "timetable-on", "joint-optimum-on", "saving"}
"""Turns that no call takes without more: a last answer, a given plan, or what another turn has left open."""

OF = {turn.name: turn.strategy for turn in TURNS}

CALLS: list[dict[str, Any]] = [
    {"mode": "individual"},
    {"discount": "0.9"},
    {"discount": "0.5", "window_weight": 0},
    {"discount": "0.5", "window_weight": 0, "time_limit": 60},
    {"discount": "0.9", "max_window": 1},
    {"mode": "communication", "discount": "0.9"},
    {"mode": "composite", "discount": "0.5"},
    {"mode": "composite", "discount": "0.5", "horizon": "inf"},
]


def _tasks() -> list[Task]:
    dice = Random("portfolio")
    tasks = [usar("a-b b-c c-d", human="d", robots={"rob": "b"}, kits={"k": "a"}, triage="d")]
    for family in sorted(FAMILIES):
        size, agents = SMALL[family][0]
        tasks.append(FAMILIES[family](dice, size, AGENTS[:agents]))
    return tasks


TASKS = _tasks()


@pytest.fixture(scope="module")
def optima() -> dict[tuple[int, int], Result]:
    """The answers of all strategies together."""
    return {
        (i, j): serendipity.plan(replace(task), **options)
        for i, task in enumerate(TASKS)
        for j, options in enumerate(CALLS)
    }


@cache
def _alone(name: str, i: int, j: int) -> Result:
    """The answer of a strategy or turn, beside those that the others stand on."""
    return serendipity.plan(replace(TASKS[i]), strategies=f"human-plan,bound,{name}", **CALLS[j])


def _claims_no_more(answer: Result, optimum: Result) -> None:
    """Assert that an answer is not better than the optimum, and its bound not above it."""
    if answer.status in ("optimal", "infeasible"):
        assert (answer.status, answer.objective) == (optimum.status, optimum.objective)
    if answer.objective is not None and optimum.objective is not None and not optimum.opportunity:
        assert answer.cost is not None and optimum.cost is not None and answer.cost >= optimum.cost - 1e-9
    if answer.lower_bound is not None and optimum.objective is not None:
        assert answer.lower_bound <= optimum.objective + 1e-9


@pytest.mark.long
@pytest.mark.parametrize("name", NAMES)
def test_one_alone(name: str, optima: dict[tuple[int, int], Result]) -> None:
    for (i, j), optimum in optima.items():
        answer = _alone(name, i, j)
        assert {OF[row["name"]] for row in answer.statistics["strategies"]} <= {
            "human-plan",
            "bound",
            OF.get(name, name),
        }
        _claims_no_more(answer, optimum)
        if answer.status == "feasible":
            assert serendipity.check(TASKS[i], answer).verdict != "refuted"


@pytest.mark.long
@pytest.mark.parametrize("name", NAMES)
def test_all_but_one(name: str, optima: dict[tuple[int, int], Result]) -> None:
    for (i, j), optimum in optima.items():
        answer = serendipity.plan(replace(TASKS[i]), strategies=f"-{name}", **CALLS[j])
        _claims_no_more(answer, optimum)
        if name not in ("human-plan", "optimal-plan", "all-plans", "all"):
            assert (answer.status, answer.objective) == (optimum.status, optimum.objective)


@pytest.mark.skipif(library() is None, reason="some turns need the kernel")
@pytest.mark.parametrize("name", sorted({*OF} - BEGUN_BY_OTHERS))
def test_some_call_takes_it(name: str, optima: dict[tuple[int, int], Result]) -> None:
    taken = {row["name"] for i, j in optima for row in _alone(name, i, j).statistics["strategies"]}
    assert name in taken, (
        f"nothing here tests the turn '{name}': add a call to CALLS, or a task, that takes it"
    )


def test_each_says_what_it_does() -> None:
    assert len({turn.name for turn in TURNS}) == len(TURNS)
    assert {turn.strategy for turn in TURNS} == {*STRATEGIES}
    assert all(turn.does and 0 < turn.share <= 1 for turn in TURNS)
    assert not [
        turn.name for turn in TURNS if turn.does.startswith("The same")
    ]  # as another row of the table?


def test_none_is_left_without_saying_so() -> None:
    answer = serendipity.plan(TASKS[0], strategies="all")
    assert (answer.status, answer.reason) == ("unknown", "strategies")


@pytest.mark.skipif(library() is None, reason="the joint optimum needs the kernel")
def test_what_only_bounds_ends_without_a_time_limit() -> None:
    """It went on while others would have proved the answer, for minutes beside a robot at work."""
    task = FAMILIES["switches"](Random("limit"), 4, AGENTS[:3])
    assert all(turn.limit for turn in TURNS if turn.name == "joint-bound")
    soon = [turn._replace(limit=1) if turn.name == "joint-bound" else turn for turn in TURNS]
    options = Options(mode="communication", communication_weight=1, discount="0.9")
    *_, answer = solve(PreparedTask(task), options, turns=soon)
    *_, unlimited = solve(PreparedTask(task), options)
    tried = {one.name: one for one in answer.tried}
    assert "all" in tried and not tried["joint-bound"].settled
    assert (answer.status, answer.objective) == ("optimal", unlimited.objective)


def test_names_that_are_none() -> None:
    with pytest.raises(UsageError, match="there is no 'al'; expected some of human-plan, "):
        serendipity.plan(TASKS[0], strategies="al")
    for names in (3, "", " , "):
        with pytest.raises(UsageError, match="strategies: expected names"):
            serendipity.plan(TASKS[0], strategies=names)  # type: ignore[arg-type]
    assert [turn.name for turn in chosen(["all", "bound"])] == ["bound", "all"]
    assert [turn.name for turn in chosen(["timetable", "-timetable-on"])] == [
        "timetable-soon",
        "timetable-last",
    ]
    assert not {"ties", "all"} & {turn.name for turn in chosen(["-all-plans"])}


def test_where_the_time_went_is_told() -> None:
    answer = serendipity.plan(serendipity.example("room2"), discount=0.6, strategies="human-plan,bound,all")
    rows = answer.statistics["strategies"]
    assert [row["name"] for row in rows] == ["optimal-plan", "bound", "all"]
    assert [row["better"] for row in rows] == [0, 0, 1]
    assert rows[-1]["settled"] and rows[-1]["bound"] == answer.objective
    assert 0 < sum(row["seconds"] for row in rows) < answer.statistics["elapsed_seconds"]
    assert serendipity.Result.from_dict(answer.to_dict()).statistics["strategies"] == rows
