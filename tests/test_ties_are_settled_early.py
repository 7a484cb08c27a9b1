"""Answers over his optimal plans stop where the rest can't matter, and claim no more than is proved."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from time import process_time

import pytest
from hypothesis import given

import serendipity
from search import least_over_ties, optimal_human_plans, solve
from serendipity import UsageError
from serendipity.model import Condition, Options, Result, Task, Window
from serendipity.model.deadline import Deadline
from serendipity.ties import combined, until_settled
from tests.builders import task as build
from tests.builders import usar
from tests.cases import case_4
from tests.strategies import Call, calls


def _answers(*costs: float) -> Iterator[Result]:
    """Proved answers to calls in which ``pi_H`` costs 8."""
    for cost in costs:
        yield Result(
            "serendipity",
            "optimal",
            "h",
            Options(),
            human_cost=8.0,
            cost=cost,
            objective=cost,
            lower_bound=cost,
            horizon=3,
        )
    raise AssertionError("one answer too many was asked for")


def _never() -> float:
    raise AssertionError("a bound was asked for")


def _costs(answers: Iterator[Result]) -> list[float | None]:
    return [answer.cost for answer in answers]


def test_nothing_is_dearer_than_his_plan() -> None:
    assert _costs(until_settled(_answers(6, 8), "robust", bounded=True, least=_never)) == [6, 8]


def test_nothing_is_cheaper_than_the_bound() -> None:
    answers = until_settled(_answers(8, 7, 6, 8, 7, 6), "optimistic", bounded=True, least=lambda: 6.0)
    assert _costs(answers) == [8, 7, 6, 8, 7, 6]


def test_where_nothing_can_help_all_are_equal() -> None:
    answers = list(until_settled(_answers(8, 8, 8, 8), "expected", bounded=True, least=lambda: 8.0))
    assert combined(answers, "expected").cost == 8
    with pytest.raises(AssertionError, match="one answer too many"):
        list(until_settled(_answers(8, 8, 8, 8), "expected", bounded=True, least=lambda: 7.0))


def test_robots_with_goals_leave_nothing_out() -> None:
    with pytest.raises(AssertionError, match="one answer too many"):
        list(until_settled(_answers(8, 8), "robust", bounded=False, least=_never))


def test_least_cost_is_not_proved_while_one_answer_is_not() -> None:
    """It was: the cheapest answer was proved, although another could have got cheaper still."""
    proved = Result("serendipity", "optimal", "h", Options(), cost=6.2, objective=1006.2, lower_bound=1006.2)
    stopped = Result("serendipity", "feasible", "h", Options(), cost=8.0, objective=8.0, lower_bound=5.5)
    answer = combined([proved, stopped], "optimistic")
    assert (answer.status, answer.cost, answer.lower_bound) == ("feasible", 6.2, 5.5)
    assert combined([stopped, proved], "robust").status == "feasible"
    assert combined([proved], "optimistic").status == "optimal"


def _stopped(status: str, cost: float | None) -> Result:
    """An answer before which a limit came; ``pi_H`` costs 8."""
    bound = None if cost is None else 1.0
    return Result(
        "serendipity", status, "h", Options(), human_cost=8.0, cost=cost, objective=cost, lower_bound=bound
    )


def test_after_a_limit_nothing_more_is_looked_at() -> None:
    """They all were, one after another: a limit of 0.5 s took 3.3."""
    for ties in ("optimistic", "expected"):
        answers = [*_some(6.0), _stopped("feasible", 7.0)]
        assert _costs(until_settled(_then_never(answers), ties, bounded=True, least=_never)) == [6, 7]
    answers = [*_some(6.0), _stopped("feasible", 7.0), _stopped("feasible", 8.0)]
    assert _costs(until_settled(_then_never(answers), "robust", bounded=True, least=_never)) == [6, 7, 8]
    answers = [_stopped("unknown", None)]
    assert _costs(until_settled(_then_never(answers), "robust", bounded=True, least=_never)) == [None]


def test_what_is_missing_may_cost_less_than_the_least() -> None:
    answers = [*_some(6.0), _stopped("unknown", None)]
    answer = combined(answers, "optimistic", everyone=False)
    assert (answer.status, answer.cost, answer.lower_bound) == ("feasible", 6.0, 0.0)
    assert combined(answers, "expected", everyone=False).status == "unknown"


def _some(cost: float) -> list[Result]:
    return [next(_answers(cost))]


def _then_never(answers: list[Result]) -> Iterator[Result]:
    yield from answers
    raise AssertionError("one answer too many was asked for")


@given(calls(modes=("serendipity", "communication"), ties=False))
def test_the_bound_is_one(call: Call) -> None:
    task = replace(call.task, robot_goal=Condition())
    graph = optimal_human_plans(task)
    if graph is None or not 1 < graph.count() <= 12:
        return
    options = call.options
    bound = least_over_ties(task, options, graph, Deadline())
    assert bound is not None
    costs = []
    for plan in graph.plans():
        *_, outcome = solve(task, options, human_plan=plan)
        assert outcome.cost is not None, "he can be left alone"
        costs.append(outcome.cost)
    assert bound <= min(costs)


def test_the_bound_is_met_where_windows_are_short() -> None:
    """In the grid help is met in one epoch: K decides, and 58,212 plans are answered by 4."""
    task = _grid(7, kits={"k1": "x6y6", "k2": "x6y5"})
    graph = optimal_human_plans(task)
    assert graph is not None
    assert graph.count() == 58_212
    answer = serendipity.plan(task, discount="0.9", ties="optimistic", max_ties=10**6)
    assert (answer.status, answer.cost, answer.window) == ("optimal", 21.0, Window(11, 12))
    assert len(answer.statistics["ties"]) == 4


def _grid(size: int, kits: Mapping[str, str]) -> Task:
    edges = [f"x{i}y{j}-x{i + 1}y{j}" for i in range(size - 1) for j in range(size)]
    edges += [f"x{i}y{j}-x{i}y{j + 1}" for i in range(size) for j in range(size - 1)]
    return usar(" ".join(edges), human="x0y0", robots={"rob": "x2y1"}, kits=kits, triage="x1y1")


def test_plans_are_counted_not_listed() -> None:
    """Plans share their steps: counting them looks at each step once."""
    task = _grid(7, kits={"k": "x6y6"})
    started = process_time()
    graph = optimal_human_plans(task)
    assert graph is not None
    count = graph.count()
    assert count > 10**5
    assert process_time() - started < 5
    with pytest.raises(UsageError) as error:
        serendipity.plan(task, ties="robust")
    assert str(error.value) == (
        f"max_ties: the human has {count} optimal plans, more than 1000; raise max_ties, or use ties 'fixed'"
    )


@pytest.mark.parametrize("ties", ["robust", "optimistic", "expected"])
def test_what_does_not_matter_is_left_out_and_still_certified(ties: str) -> None:
    """There are 20 ways to the kit and back; the robot has nothing that could help."""
    task = build(
        goal="done",
        init="a",
        actions={
            **{f"way{k} h": "a -> b !a" for k in range(20)},
            "do h": "b -> done",
            "idle r": "-> waved",
        },
    )
    answer = serendipity.plan(task, discount="0.9", ties=ties)
    assert (answer.cost, answer.statistics["optimal_plans"]) == (2.0, 20)
    assert len(answer.statistics["ties"]) == (1 if ties == "robust" else 4)
    assert serendipity.verify(task, answer).verdict == "proved"


def test_listed_answers_are_certified() -> None:
    answer = serendipity.plan(case_4(), discount="0.9", ties="robust")
    for ties in ([], [{**answer.statistics["ties"][0], "cost": 7.0}]):
        doctored = Result.from_dict({**answer.to_dict(), "statistics": {**answer.statistics, "ties": ties}})
        assert serendipity.verify(case_4(), doctored).verdict == "refuted"
