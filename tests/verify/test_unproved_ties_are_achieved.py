"""A feasible answer over ties lists answers that can be had, and its figures are theirs (semantics 1)."""

from dataclasses import replace
from typing import Any

import pytest

import serendipity
from serendipity.model import Result
from serendipity.model.answers.result_parts import TiedAnswer
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_4
from serendipity_testing.countdown import Countdown

TIES = ("expected", "robust", "optimistic")


def answered(ties: str, **options: Any) -> Result:
    return serendipity.plan(case_4(), discount="0.9", ties=ties, **options)


def unproved(answer: Result, **changes: Any) -> Result:
    """An answer that says that a limit came."""
    return replace(answer, **{"status": "feasible", "lower_bound": 0.0, **changes})


def listed(answer: Result) -> tuple[TiedAnswer, ...]:
    assert answer.ties is not None
    return answer.ties


def verdict(answer: Result, **how: Any) -> str:
    again = Result.from_dict(answer.to_dict())
    assert again == answer
    return serendipity.verify(case_4(), again, **how).verdict


@pytest.mark.long
@pytest.mark.parametrize("ties", TIES)
def test_whenever_time_runs_out_the_answer_can_be_had(ties: str) -> None:
    """Each answer that is not proved comes with its plan, so that it is proved to be possible."""
    several = 0
    for looks in range(200, 4_000, 100):
        early = answered(ties, deadline=Countdown(looks))
        if early.status == "feasible":
            several += len(listed(early)) > 1
            assert verdict(early) == "proved"
    assert several or ties == "optimistic"


def test_figures_that_nobody_achieves_are_refuted() -> None:
    mean = answered("expected")
    cheap, dear = sorted(listed(mean), key=lambda answer: answer.cost or 0)
    assert (cheap.cost, dear.cost, mean.cost) == (6.2, 8, 7.1)
    made_up = tuple(replace(each, cost=0.5, opportunity=True) for each in (cheap, dear))
    for cost, ties in (
        (0.5, made_up),
        (6.2, (cheap, cheap)),
        (5.0, (cheap, replace(dear, cost=3.8, opportunity=True))),
        (7.1, (cheap, replace(dear, human_plan=(*dear.human_plan[1:], dear.human_plan[0])))),
    ):
        false = unproved(mean, cost=cost, objective=cost, saving=8 - cost, ties=ties)
        assert verdict(false) == "refuted"
    as_cheap = (cheap, replace(cheap, human_plan=dear.human_plan))  # a longer window may do that, for more
    assert verdict(unproved(mean, cost=6.2, objective=6.2, saving=1.8, ties=as_cheap)) == "undecided"
    assert verdict(unproved(mean, objective=7.1)) == "refuted"
    assert verdict(unproved(mean, saving=1.0)) == "refuted"


def test_a_mean_of_some_is_none_of_all() -> None:
    one = answered("optimistic")
    alone = replace(one, options=answered("expected").options, ties=(listed(one)[0],), optimal_plans=2)
    assert verdict(unproved(alone)) == "refuted"
    nothing = answered("robust")
    idle = tuple(each for each in listed(nothing) if each.human_plan == nothing.human_plan)
    assert verdict(unproved(replace(nothing, options=alone.options, ties=idle))) == "proved"


@pytest.mark.parametrize(("ties", "other"), [("robust", "optimistic"), ("optimistic", "robust")])
def test_the_dearest_is_not_the_cheapest(ties: str, other: str) -> None:
    false = replace(answered(other), options=answered(ties).options)
    assert verdict(unproved(false)) == "refuted"


def test_a_plan_that_is_listed_has_to_be_one() -> None:
    early = next(
        answer
        for answer in (answered("robust", deadline=Countdown(looks)) for looks in range(200, 4_000, 50))
        if answer.status == "feasible" and len(listed(answer)) > 1
    )
    other = next(each for each in listed(early) if each.human_plan != early.human_plan)
    assert other.plan is not None
    for wrong in (
        replace(other, plan=other.plan[:-1]),
        replace(other, plan=(replace(other.plan[0], epoch=2), *other.plan[1:])),
        replace(other, cost=(other.cost or 0) - 1, plan=other.plan),
    ):
        ties = tuple(wrong if each is other else each for each in listed(early))
        assert verdict(replace(early, ties=ties)) == "refuted"


@pytest.mark.parametrize("ties", TIES)
def test_what_is_saved_counts_from_what_robots_pay_for_goals_of_their_own(ties: str) -> None:
    actions = {"do h": "-> g @ 5", "quick h": "q -> g @ 1", "see to it r": "-> q @ 2"}
    task = build(goal="g", robot_goal="q", actions=actions)
    right = serendipity.plan(task, mode="communication", horizon=2, ties=ties)
    assert (right.cost, right.saving) == (3.0, 4.0)
    assert serendipity.verify(task, right).verdict == "proved"
    for status in ("optimal", "feasible"):
        assert serendipity.verify(task, replace(right, status=status, saving=2.0)).verdict == "refuted"
