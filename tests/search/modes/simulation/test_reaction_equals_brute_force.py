"""Planning under a human model finds the optimum over all sequences of robots' actions."""

import pytest
from hypothesis import given

from search import PreparedTask
from search.modes.simulation import simulate
from search.modes.simulation.planner import solve_for_human
from serendipity.model.answers.answer import Answer
from serendipity_testing.oracle.reactions import best_reaction
from tests.search.modes.simulation.strategies import Reaction, reactions

MODELS = ["observant", "local"]


@pytest.mark.long
@pytest.mark.parametrize("human_model", MODELS)
def test_reaction_equals_brute_force(human_model: str) -> None:
    @given(reactions(human_model))
    def law(case: Reaction) -> None:
        optimum = best_reaction(case.task, case.options, case.human_plan, case.visible)
        *_, outcome = solve_for_human(
            PreparedTask(case.task),
            case.options,
            human_plan=case.human_plan if case.given else None,
            visible=case.visible if human_model == "local" else None,
        )
        baseline = case.task.cost_of(case.human_plan)
        if case.task.robot_goal:
            assert outcome.cost == optimum.cost
        else:
            assert optimum.cost is not None
            assert outcome.cost == min(optimum.cost, baseline)
        assert outcome.status == ("infeasible" if outcome.cost is None else "optimal")
        assert outcome.lower_bound == outcome.objective == outcome.cost
        if outcome.opportunity and outcome.steps is not None:
            assert len(outcome.steps) == optimum.actions
            _assert_happens(case, human_model, outcome)

    law()


def _assert_happens(case: Reaction, human_model: str, outcome: Answer) -> None:
    played = simulate(
        PreparedTask(case.task),
        case.options,
        case.human_plan,
        outcome.steps,
        human_model=human_model,
        horizon=outcome.horizon,
        visible=case.visible if human_model == "local" else None,
    )
    assert played.steps == outcome.steps
    assert played.realised(outcome.cost)
