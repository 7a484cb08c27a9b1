"""Plans of the library, both ways."""

from fractions import Fraction
from itertools import pairwise

import pytest
from unified_planning.engines import PlanGenerationResultStatus, SequentialPlanValidator
from unified_planning.environment import get_environment
from unified_planning.plans import ActionInstance, ContingentPlan, PartialOrderPlan, PlanKind, SequentialPlan

import serendipity
from serendipity.model import PlanError, UsageError
from serendipity.testing.builders import task as build
from serendipity.up import EpochPlan, from_problem, predict, to_plan, to_problem
from serendipity.up.engine import SerendipityEngine
from serendipity.up.plans import human_plan_of
from serendipity.up.reading import read
from tests.up.problems import corridor, kitchen

get_environment().credits_stream = None
TEAM = {"human": "Ann", "robots": ["Robot"]}


def test_every_order_of_an_epoch_plan_is_a_plan() -> None:
    problem = kitchen()
    result = serendipity.plan(from_problem(problem, **TEAM), discount=0.5)
    plan = to_plan(result, problem)
    assert isinstance(plan, EpochPlan)
    assert sorted(plan.epochs.values()) == sorted(step.epoch for step in result.plan)
    orders = list(plan.all_sequential_plans())
    assert len(orders) > 3
    assert all(SequentialPlanValidator().validate(problem, order) for order in orders)


def test_a_sequence_is_written_where_it_is_wanted() -> None:
    problem = kitchen()
    result = serendipity.plan(from_problem(problem, **TEAM), mode="composite", horizon="inf")
    plan = to_plan(result, problem, sequential=True)
    assert isinstance(plan, SequentialPlan)
    assert SequentialPlanValidator().validate(problem, plan)
    assert to_plan(serendipity.plan(from_problem(problem, **TEAM), time_limit=0), problem) is None


def test_plans_of_one_who_does_all_are_sequences() -> None:
    problem = kitchen()
    plan = to_plan(serendipity.plan(from_problem(problem), mode="individual"), problem)
    assert isinstance(plan, SequentialPlan)
    assert len(plan.actions) == 7


def test_what_can_be_done_at_once_only_is_no_plan() -> None:
    """Each of two swaps what the other one needs."""
    task = build(init="a b", goal="!a !b", actions={"x h": "a b -> !a", "y r": "a b -> !b"})
    problem = to_problem(task)
    again = from_problem(problem, human="h", robots="r")
    result = serendipity.plan(again, mode="composite", horizon="inf")
    assert result.status == "optimal"
    with pytest.raises(PlanError, match=r"epoch 1: .* at once only"):
        to_plan(result, problem)
    paper = SerendipityEngine(human="h", robots="r", interference="paper").solve(problem)
    assert (paper.status, paper.plan) == (PlanGenerationResultStatus.UNSOLVABLE_INCOMPLETELY, None)
    with pytest.raises(PlanError, match="'x h' is not an action of the problem"):
        to_plan(serendipity.plan(task, mode="composite", horizon="inf"), problem)
    assert (
        serendipity.plan(task, mode="composite", horizon="inf", interference="strict").status == "infeasible"
    )


def plan_of(problem: object, *names: str) -> SequentialPlan:
    vocabulary = read(problem, **TEAM).vocabulary
    return SequentialPlan([vocabulary.instance(name) for name in names])


BEST = (
    "walk ann sofa corridor",
    "walk ann corridor hall",
    "walk ann hall pantry",
    "take ann pantry",
    "walk ann pantry hall",
    "walk ann hall kitchen",
    "brew ann",
)


def test_the_humans_plan_is_taken_from_a_plan_of_all() -> None:
    problem = kitchen()
    reading = read(problem, **TEAM)
    plan = plan_of(problem, *BEST[:3], "walk robot pantry hall", *BEST[3:])
    assert human_plan_of(plan, reading) == BEST
    order = plan.convert_to(PlanKind.PARTIAL_ORDER_PLAN, problem)
    assert human_plan_of(order, reading) == BEST
    assert human_plan_of(BEST, reading) == BEST
    with pytest.raises(UsageError, match="'hand_over robot ann' is not an action that ann can do alone"):
        human_plan_of(plan_of(problem, "hand_over robot ann"), reading)
    with pytest.raises(UsageError, match="CONTINGENT_PLAN: expected"):
        human_plan_of(ContingentPlan(None), reading)
    stranger = corridor()
    other = SequentialPlan(
        [ActionInstance(stranger.agent("Ann").action("push"), agent=stranger.agent("Ann"))]
    )
    with pytest.raises(UsageError, match="is not of the problem"):
        human_plan_of(other, reading)


def test_a_plan_that_is_given_decides_where_help_comes() -> None:
    problem = kitchen()
    detour = plan_of(problem, BEST[0], "walk ann corridor sofa", *BEST)
    options = {"mode": "serendipity", "discount": "1/2", **TEAM}
    result = SerendipityEngine(**options, human_plan=detour).solve(problem)
    assert float(result.metrics["human_cost"]) == 9
    assert result.metrics == {
        **SerendipityEngine(**options).solve(problem, human_plan=detour).metrics,
        "engine_internal_time": result.metrics["engine_internal_time"],
    }


def test_any_engine_predicts_the_human() -> None:
    task = from_problem(kitchen(), **TEAM)
    assert predict(task, "serendipity") == BEST
    result = SerendipityEngine(mode="serendipity", discount="1/2", predict_with="serendipity", **TEAM)
    assert float(result.solve(kitchen()).metrics["cost"]) == 6
    assert predict(task.with_human("robot"), "serendipity") is None
    with pytest.raises(UsageError, match="TIMEOUT"):
        predict(task, "serendipity", time_limit=0)


def test_rational_costs_are_made_whole_for_other_engines() -> None:
    actions = {"slow h": "a -> b @ 7/3", "long h": "a -> c @ 1/2", "on h": "c -> b @ 1/3"}
    task = build(init="a", goal="b", actions=actions)
    assert predict(task, "serendipity") == ("long h", "on h")
    problem = to_problem(task)
    costs = {a.name: c.constant_value() for a, c in problem.quality_metrics[0].costs.items()}
    assert set(costs.values()) == {Fraction(7, 3), Fraction(1, 2), Fraction(1, 3)}


def test_plans_are_validated() -> None:
    problem = kitchen()
    validator = SerendipityEngine(**TEAM)
    good = plan_of(problem, *BEST)
    verdict = validator.validate(problem, good)
    assert verdict
    assert verdict.metric_evaluations == {problem.quality_metrics[0]: 7}
    early = validator.validate(problem, plan_of(problem, *BEST[:2], "brew ann"))
    assert (early.status.name, early.reason.name) == ("INVALID", "INAPPLICABLE_ACTION")
    assert str(early.inapplicable_action) == "brew(Ann)"
    short = validator.validate(problem, plan_of(problem, *BEST[:-1]))
    assert (short.status.name, short.reason.name) == ("INVALID", "UNSATISFIED_GOALS")


def test_an_order_that_is_too_loose_is_no_plan() -> None:
    problem = kitchen()
    steps = plan_of(problem, *BEST).actions
    tight = PartialOrderPlan({a: [b] for a, b in pairwise(steps)})
    loose = PartialOrderPlan({**{a: [b] for a, b in pairwise(steps[:-1])}, steps[-1]: []})
    validator = SerendipityEngine()
    assert validator.validate(problem, tight)
    verdict = validator.validate(problem, loose)
    assert (verdict.status.name, verdict.reason.name) == ("INVALID", "INAPPLICABLE_ACTION")
