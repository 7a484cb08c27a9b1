"""Answers over ties stop where the rest can't matter, and claim no more than is proved."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from time import process_time
from typing import Any

import pytest
from hypothesis import given

import serendipity
from search import PreparedTask, least_over_ties, optimal_human_plans, solve
from serendipity import UsageError
from serendipity.facade.ties import combined, until_settled
from serendipity.model import Condition, Options, Task, Window
from serendipity.model.answers.answer import Answer
from serendipity.model.keywords import Ties
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.builders import task as build
from serendipity_testing.builders import usar
from serendipity_testing.oracle import best
from serendipity_testing.strategies import Call, calls
from tests.search.exact_answers import proved


def _answered(
    status: str, cost: float | str | None = None, bound: float | str | None = None, window: int = 0
) -> Answer:
    """An answer to a call in which ``pi_H`` costs 8; ``window`` is what its window adds to the objective."""
    if cost is None:
        return Answer(status)
    exact = Fraction(cost)
    return Answer(
        status,
        cost=exact,
        objective=exact + window,
        lower_bound=exact + window if bound is None else Fraction(bound),
        baseline=Fraction(8),
        opportunity=exact < 8,
    )


def _answers(*costs: float) -> Iterator[Answer]:
    """Proved answers."""
    for cost in costs:
        yield _answered("optimal", cost)
    raise AssertionError("one answer too many was asked for")


def _never() -> Fraction:
    raise AssertionError("a bound was asked for")


def _costs(answers: Iterator[Answer]) -> list[Fraction | None]:
    return [answer.cost for answer in answers]


def test_nothing_is_dearer_than_his_plan_nor_cheaper_than_the_bound() -> None:
    assert _costs(until_settled(_answers(6, 8), "robust", bounded=True, least=_never)) == [6, 8]
    answers = until_settled(_answers(8, 7, 6, 8, 7, 6), "optimistic", bounded=True, least=lambda: Fraction(6))
    assert _costs(answers) == [8, 7, 6, 8, 7, 6]


def test_where_nothing_can_help_all_are_equal() -> None:
    answers = list(until_settled(_answers(8, 8, 8, 8), "expected", bounded=True, least=lambda: Fraction(8)))
    assert combined(answers, "expected").cost == 8
    with pytest.raises(AssertionError, match="one answer too many"):
        list(until_settled(_answers(8, 8, 8, 8), "expected", bounded=True, least=lambda: Fraction(7)))


def test_robots_with_goals_leave_nothing_out() -> None:
    with pytest.raises(AssertionError, match="one answer too many"):
        list(until_settled(_answers(8, 8), "robust", bounded=False, least=_never))


@pytest.mark.parametrize(
    ("ties", "proved", "stopped", "cost", "bound"),
    [
        ("optimistic", {"cost": "6.2", "window": 1000}, {"cost": 8, "bound": "5.5"}, "6.2", "5.5"),
        ("robust", {"cost": 7}, {"cost": "7.5", "bound": "1006.2", "window": 1000}, "7.5", "7"),
        ("expected", {"cost": 3}, {"cost": 8, "bound": 6}, "5.5", "4.5"),
    ],
)
def test_nothing_is_proved_while_one_answer_is_not(
    ties: Ties, proved: dict[str, Any], stopped: dict[str, Any], cost: str, bound: str
) -> None:
    """The cheapest was, although another could have got cheaper still; of the dearest one the bound was above
    the objective of what may be the dearest in the end; and a mean had the first such answer's bound.
    """
    found = combined([_answered("optimal", **proved), _answered("feasible", **stopped)], ties)
    assert (found.status, found.cost, found.lower_bound) == ("feasible", Fraction(cost), Fraction(bound))
    assert combined([_answered("optimal", **proved)], ties).status == "optimal"


def test_means_are_exact() -> None:
    """A mean of floats is not the nearest float of the mean: 11/15 was 0.7333333333333334."""
    task = build(
        goal="done",
        actions={
            "sit h": "-> sat @ 0",
            "slow h": "sat -> done @ 1.4",
            "stand h": "-> up @ 0",
            "steep h": "up -> done @ 1.4",
            "pull r": "up -> done @ 0.1",
        },
    )
    answer = proved(task, discount="1/3", ties="expected")
    assert [entry.cost for entry in answer.ties or ()] == [1.4, float(Fraction(1, 15))]
    assert answer.cost == float(Fraction(11, 15)) != 0.7333333333333334


def test_after_a_limit_nothing_more_is_looked_at() -> None:
    """They all were, one after another: a limit of 0.5 s took 3.3."""
    for ties in ("optimistic", "expected"):
        answers = [*_some(6.0), _answered("feasible", 7, bound=1)]
        assert _costs(until_settled(_then_never(answers), ties, bounded=True, least=_never)) == [6, 7]
    answers = [*_some(6.0), _answered("feasible", 7, bound=1), _answered("feasible", 8, bound=1)]
    assert _costs(until_settled(_then_never(answers), "robust", bounded=True, least=_never)) == [6, 7, 8]
    answers = [_answered("unknown")]
    assert _costs(until_settled(_then_never(answers), "robust", bounded=True, least=_never)) == [None]


def test_what_is_missing_may_cost_less_than_the_least_or_have_no_plan() -> None:
    """It was feasible, and infeasible with more time; and a mean of some answers was one of them."""
    answers = [*_some(6.0), _answered("unknown")]
    answer = combined(answers, "optimistic", everyone=False)
    assert (answer.status, answer.cost, answer.lower_bound) == ("feasible", 6.0, 0.0)
    assert combined(answers, "expected", everyone=False).status == "unknown"
    for more, ties, bounded in (
        (answers, "optimistic", False),  # robots have goals
        ([*_some(8), _answered("feasible", 6, bound=5)], "expected", True),
    ):
        found = combined(more, ties, bounded=bounded, everyone=False, limit="time-limit")
        assert (found.status, found.reason, found.cost) == ("unknown", "time-limit", None)


def _some(cost: float) -> list[Answer]:
    return [next(_answers(cost))]


def _then_never(answers: list[Answer]) -> Iterator[Answer]:
    yield from answers
    raise AssertionError("one answer too many was asked for")


@given(calls(modes=("serendipity", "communication"), ties=False))
def test_the_bound_is_one(call: Call) -> None:
    task = replace(call.task, robot_goal=Condition())
    graph = optimal_human_plans(PreparedTask(task))
    if graph is None or not 1 < graph.count() <= 12:
        return
    options = call.options
    bound = least_over_ties(PreparedTask(task), options, graph, Deadline())
    assert bound is not None
    costs = []
    for plan in graph.plans():
        *_, outcome = solve(PreparedTask(task), options, human_plan=plan)
        assert outcome.cost is not None, "he can be left alone"
        costs.append(outcome.cost)
    assert bound <= min(costs)


def test_the_bound_is_met_where_windows_are_short() -> None:
    """In the grid help is met in one epoch: K decides, and 58,212 plans are answered by 4."""
    task = _grid(7, kits={"k1": "x6y6", "k2": "x6y5"})
    graph = optimal_human_plans(PreparedTask(task))
    assert graph.count() == 58_212
    answer = serendipity.plan(task, discount="0.9", ties="optimistic", max_ties=10**6)
    assert (answer.status, answer.cost, answer.window) == ("optimal", 21.0, Window(11, 12))
    assert len(answer.ties or ()) == 4


def _grid(size: int, kits: Mapping[str, str]) -> Task:
    edges = [f"x{i}y{j}-x{i + 1}y{j}" for i in range(size - 1) for j in range(size)]
    edges += [f"x{i}y{j}-x{i}y{j + 1}" for i in range(size) for j in range(size - 1)]
    return usar(" ".join(edges), human="x0y0", robots={"rob": "x2y1"}, kits=kits, triage="x1y1")


def test_plans_are_counted_not_listed() -> None:
    """Plans share their steps: counting them looks at each step once."""
    task = _grid(7, kits={"k": "x6y6"})
    started = process_time()
    graph = optimal_human_plans(PreparedTask(task))
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
        actions={**{f"way{k} h": "a -> b !a" for k in range(20)}, "do h": "b -> done", "idle r": "-> waved"},
    )
    answer = proved(task, discount="0.9", ties=ties)
    assert (answer.cost, answer.optimal_plans) == (2.0, 20)
    assert len(answer.ties or ()) == (1 if ties == "robust" else 4)


def test_no_mean_saving_where_doing_nothing_is_no_answer() -> None:
    """It was 0, while each single answer had none."""
    task = build(goal="a b", robot_goal="c", actions={"one h": "-> a", "two h": "-> b", "both h r": "-> c"})
    answer = proved(task, mode="communication", ties="expected", horizon=3)
    assert len(answer.ties or ()) == 2
    assert (answer.status, answer.saving, answer.saving_alone) == ("optimal", None, None)


@pytest.mark.parametrize("ties", ["robust", "expected"])
def test_where_doing_nothing_is_no_answer_a_human_who_replans_is_helped(ties: str) -> None:
    """The certificate saw no opportunity without a baseline."""
    task = build(
        init="dirty",
        goal="done",
        robot_goal="!dirty",
        actions={"do h": "-> done", "make h": "-> done", "both h r": "-> done !dirty @ 1/2"},
    )
    answer = proved(task, human_model="observant", ties=ties)
    assert (answer.status, answer.opportunity, answer.saving) == ("optimal", True, None)


def test_composite_mode_counts_savings_from_the_canonical_plan() -> None:
    """Brute force took the mean over both: only beside the canonical one has the robot time for its goal."""
    task = build(
        goal="a b",
        robot_goal="c",
        actions={"one h": "-> a", "two h": "-> b", "see r": "a -> c @ 1", "both h r": "-> a b @ 0.5"},
    )
    options = Options(mode="composite", ties="expected")
    answer, optimum = serendipity.plan(task, mode="composite", ties="expected"), best(task, options)
    assert (answer.cost, answer.saving) == (optimum.cost, optimum.saving) == (1.5, 1.5)
