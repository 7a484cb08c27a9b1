"""When the time is up: bounds that hold, and a policy that is worth its upper one (SPEC 7)."""

from fractions import Fraction

import pytest

import serendipity
from search import Clock
from search.assistance.game import Game
from search.assistance.relaxed import joint_lower_bound, upper_bound_alone
from tests.assistance.oracle import by_rounds, explore
from tests.builders import task
from tests.cases import case_5, case_6

TIES = ("optimistic", "fixed", "robust", "expected")


@pytest.mark.parametrize("ties", TIES)
@pytest.mark.parametrize("case", [case_5, case_6])
def test_no_time_leaves_doing_nothing(case, ties: str) -> None:
    result = serendipity.plan(case(), mode="assistance", ties=ties, time_limit=0)
    lower, upper = (tuple(map(Fraction, result.statistics["bounds"][side])) for side in ("lower", "upper"))
    proved = tuple(
        map(Fraction, serendipity.plan(case(), mode="assistance", ties=ties).statistics["bounds"]["upper"])
    )
    assert lower <= proved <= upper == (2, 0)
    assert result.status == ("optimal" if lower == upper else "feasible")
    assert (result.lower_bound < result.objective) == (result.status == "feasible")


def test_no_time_and_no_plan_alone_is_unknown() -> None:
    helpless = task(goal="g", actions={"open r": "-> x @ 2", "finish r": "x -> g @ 3"})
    result = serendipity.plan(helpless, mode="assistance", time_limit=0)
    assert (result.status, result.policy, result.cost) == ("unknown", None, None)


@pytest.mark.parametrize("case", [case_5, case_6])
def test_relaxed_bounds_enclose_the_optimum(case) -> None:
    game = Game(case(), Clock())
    optimum = by_rounds(explore(case(), fixed=False, no_block=False), min)
    assert game.pair(joint_lower_bound(game)) <= optimum
    assert game.pair(upper_bound_alone(game)) >= (2, 0)
