"""What is read means what the problem says: optima are those that the library's own simulator finds."""

import pytest
from unified_planning.engines import PlanGenerationResultStatus, SequentialPlanValidator

from serendipity.up.engine import SerendipityEngine
from tests.up.oracle import least_cost
from tests.up.problems import SINGLE


@pytest.mark.parametrize("name", SINGLE)
def test_optima_are_those_of_the_simulator(name: str) -> None:
    problem = SINGLE[name]()
    result = SerendipityEngine().solve(problem)
    assert result.status == PlanGenerationResultStatus.SOLVED_OPTIMALLY
    verdict = SequentialPlanValidator().validate(problem, result.plan)
    assert verdict, verdict
    (cost,) = verdict.metric_evaluations.values()
    assert cost == least_cost(problem) == float(result.metrics["cost"])
    (again,) = SerendipityEngine().validate(problem, result.plan).metric_evaluations.values()
    assert again == cost


def test_what_is_out_of_reach_is_proved_so() -> None:
    problem = SINGLE["costs"]()
    problem.clear_actions()
    result = SerendipityEngine().solve(problem)
    assert result.status == PlanGenerationResultStatus.UNSOLVABLE_PROVEN
    assert result.plan is None
