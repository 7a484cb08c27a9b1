"""A task that is written as a problem and read again has the optima that it had.

And what is read means what the problem says: optima are those that the library's own simulator finds.
"""

import pytest
from unified_planning.engines import PlanGenerationResultStatus, SequentialPlanValidator
from unified_planning.model.multi_agent import MultiAgentProblem

import serendipity
from serendipity.model import Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.generator.calls import random_call
from serendipity_up import from_problem, to_plan, to_problem
from serendipity_up.engine import SerendipityEngine
from serendipity_up.tests.oracle import least_cost
from serendipity_up.tests.problems import SINGLE

OPTIONS: tuple[dict[str, object], ...] = (
    {"mode": "composite", "horizon": "inf"},
    {"mode": "composite", "horizon": "inf", "discount": "1/3", "interference": "strict"},
    {"mode": "individual"},
    {"mode": "serendipity", "discount": "3/5"},
)


def names(task: Task) -> dict[str, object]:
    return {"human": task.agents[task.human], "robots": [task.agents[i] for i in task.robots]}


@pytest.mark.parametrize("seed", range(24))
def test_optima_come_back(seed: int) -> None:
    task = random_call(seed).task
    problem = to_problem(task)
    again = from_problem(problem, **names(task))
    for options in OPTIONS[: 2 if task.robot_goal else 4]:
        before, after = serendipity.plan(task, **options), serendipity.plan(again, **options)
        assert (before.status, before.cost, before.objective) == (after.status, after.cost, after.objective)
        if "interference" in options and after.plan is not None:
            assert SerendipityEngine(**names(task)).validate(problem, to_plan(after, problem))


def test_a_team_without_joint_actions_and_costs_is_one_of_the_library() -> None:
    task = build(
        init="a", goal="c", robot_goal="d", actions={"x h": "a -> b", "y r": "b -> c !b", "z r": "a -> d"}
    )
    problem = to_problem(task, multi_agent=True)
    assert isinstance(problem, MultiAgentProblem)
    again = from_problem(problem)
    assert (again.agents[again.human], bool(again.robot_goal)) == ("h", True)
    best = serendipity.plan(task, **OPTIONS[0]).cost
    assert best == serendipity.plan(again, **OPTIONS[0]).cost == 3
    result = SerendipityEngine().solve(problem)
    assert result.status is PlanGenerationResultStatus.SOLVED_SATISFICING
    assert len(result.plan.get_adjacency_list) == 3


@pytest.mark.parametrize(("action", "why"), [("x h r", "has several participants"), ("x h", "costs 2")])
def test_what_a_team_of_the_library_can_not_say_is_named(action: str, why: str) -> None:
    task = build(init="a", goal="b", actions={action: "a -> b @ 2"})
    with pytest.raises(UsageError, match=f"action '{action}' {why}"):
        to_problem(task, multi_agent=True)


def test_names_that_look_alike_are_kept_apart() -> None:
    task = build(
        init="a_b a.b",
        goal="c",
        actions={"do h": "a_b !a.b -> c", "do_h h": "a.b -> !a.b", "agent h r": "a_b -> c @ 5"},
    )
    again = from_problem(to_problem(task), **names(task))
    assert serendipity.plan(again, mode="composite", horizon="inf").cost == 2


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
