"""The policies that are found are the best there are."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from search import PreparedTask
from search.modes.scenarios import Candidate, solve_scenarios
from serendipity.model import Condition, Deadline, Options, Task
from serendipity.model.answers.answer import Answer
from serendipity_testing.builders import task as build
from serendipity_testing.oracle.scenarios import best_policy
from tests.endings import endings
from tests.search.modes.scenarios.strategies import options_over, scenarios

_LARGEST = {1: 4, 2: 4, 3: 3}
"""Horizons that brute force copes with, by the number of scenarios."""


def solved(task: Task, options: Options, candidates: list[Candidate]) -> Answer:
    """The last answer, which is exact."""
    *_, answer = solve_scenarios(PreparedTask(task), options, candidates)
    assert answer.status == "optimal"
    return answer


@pytest.mark.long
@given(scenarios(), st.data())
@settings(max_examples=40)
def test_search_equals_brute_force(given_: tuple[Task, list[Candidate]], data: st.DataObject) -> None:
    task, candidates = given_
    options = data.draw(options_over(candidates))
    horizon = int(options.horizon or max(len(candidate.plan) for candidate in candidates))
    if horizon > _LARGEST[len(candidates)] or len(task.actions) * horizon > 45:
        return
    best = best_policy(task, options, candidates, horizon)
    answer = solved(task, options, candidates)
    assert (answer.objective, answer.cost) == (best.objective, best.cost)
    assert (answer.opportunity, answer.baseline) == (best.opportunity, best.baseline)
    if options.risk == "mean":
        costs = (c.weight * (s.cost or 0) for c, s in zip(candidates, answer.goals or (), strict=True))
        assert sum(costs, Fraction(0)) == answer.cost


def lifted() -> tuple[Task, list[Candidate]]:
    """The human turns to one of two things, and is quicker where a robot has lifted it."""
    task = build(
        init="start",
        actions={
            "turn_x h": "start -> at_x !start",
            "turn_y h": "start -> at_y !start",
            "do_x h": "at_x -> x @ 3",
            "do_y h": "at_y -> y @ 6",
            "quick_x h": "at_x up_x -> x @ 0",
            "quick_y h": "at_y up_y -> y",
            "lift_x r": "-> up_x",
            "lift_y r": "-> up_y @ 0",
        },
    )
    candidates = [
        Candidate(
            Condition((task.facts.index(fact),)),
            task.plan_from_names([f"turn_{fact} h", f"do_{fact} h"]),
            Fraction(1, 2),
        )
        for fact in "xy"
    ]
    return task, candidates


def test_a_window_may_close_before_the_human_profits() -> None:
    """Both things are up after epoch 2; the human waits in a window of one epoch, and is quick after it."""
    task, candidates = lifted()
    answer = solved(task, Options(horizon=3, window_weight=Fraction(1), policy="fixed"), candidates)
    assert (answer.objective, answer.cost) == (Fraction(7, 2), Fraction(5, 2))


def test_there_is_an_answer_at_every_limit() -> None:
    """What is done after a window is put together last, and no limit may come between."""
    task, candidates = lifted()
    for policy, suffix in (("watching", "replan"), ("watching", "subplan"), ("fixed", "subplan")):
        options = Options(horizon=3, window_weight=Fraction(1), policy=policy, suffix=suffix)

        def ended(limit: Deadline, options: Options = options) -> Answer:
            *_, answer = solve_scenarios(PreparedTask(task), options, candidates, limit)
            return answer

        found = list(endings(ended))
        costs = [ending.cost for ending in found if isinstance(ending, Answer)]
        assert len(costs) == len(found), "an answer was known, and lost"
        assert costs[0] == Fraction(11, 2) > costs[-1]
