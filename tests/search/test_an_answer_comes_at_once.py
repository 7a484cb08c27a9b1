"""Where the optimal plan of the human alone may take long, there is an answer before it is looked for."""

from fractions import Fraction

import pytest

from search import PreparedTask
from search.human.individual_planner import IndividualPlanner
from search.kernel.library import library
from search.strategies.portfolio import solve
from serendipity.model import Options
from serendipity_testing.builders import task as build
from serendipity_testing.generator.families import family_task

pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")


class _AskedError(Exception):
    pass


def _fails(self: IndividualPlanner, state: int) -> None:
    raise _AskedError


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite"])
def test_doing_nothing_beside_a_plan_that_is_at_hand(monkeypatch: pytest.MonkeyPatch, mode: str) -> None:
    task = family_task("blocks", 5, 5)
    *_, last = solve(PreparedTask(task), Options(mode=mode))
    monkeypatch.setattr(IndividualPlanner, "canonical", _fails)
    answers = solve(PreparedTask(task), Options(mode=mode))
    first = next(answers)
    assert (first.status, first.lower_bound, first.saving, first.saving_alone) == ("feasible", 0, 0, None)
    assert first.human_plan is not None
    assert first.cost == first.objective == task.cost_of(first.human_plan)
    assert first.horizon == len(first.human_plan)
    assert isinstance(first.cost, Fraction)
    assert last.cost is not None and last.cost <= first.cost
    with pytest.raises(_AskedError):
        next(answers)


def test_not_where_the_horizon_is_too_short_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    task = family_task("blocks", 5, 5)
    monkeypatch.setattr(IndividualPlanner, "canonical", _fails)
    with pytest.raises(_AskedError):
        next(solve(PreparedTask(task), Options(mode="composite", horizon=1)))


def test_not_where_robots_have_a_goal(monkeypatch: pytest.MonkeyPatch) -> None:
    actions = {"a h": "-> p", "b r": "-> q p"}
    task = build(goal="p", robot_goal="q", actions=actions)
    monkeypatch.setattr(IndividualPlanner, "canonical", _fails)
    with pytest.raises(_AskedError):
        next(solve(PreparedTask(task), Options(mode="serendipity")))
