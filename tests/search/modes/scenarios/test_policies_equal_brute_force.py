"""The policies that are found are the best there are."""

from fractions import Fraction

from hypothesis import given, settings
from hypothesis import strategies as st

from search import PreparedTask
from search.modes.scenarios import Candidate, solve_scenarios
from serendipity.model import Options, Task
from serendipity.model.answers.answer import Answer
from serendipity.testing.oracle.scenarios import best_policy
from tests.search.modes.scenarios.strategies import options_over, scenarios

_LARGEST = {1: 4, 2: 4, 3: 3}
"""Horizons that brute force copes with, by the number of scenarios."""


def solved(task: Task, options: Options, candidates: list[Candidate]) -> Answer:
    """The last answer, which is exact."""
    *_, answer = solve_scenarios(PreparedTask(task), options, candidates)
    assert answer.status == "optimal"
    return answer


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
