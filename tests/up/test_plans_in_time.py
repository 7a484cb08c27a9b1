"""Durative actions and timed effects: read as our own, and plans are those of the library's validator."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from unified_planning.engines import PlanGenerationResultStatus as Status
from unified_planning.engines.plan_validator import TimeTriggeredPlanValidator
from unified_planning.environment import get_environment
from unified_planning.exceptions import UPUsageError
from unified_planning.model import DurativeAction, Object, Problem
from unified_planning.model.metrics import MinimizeActionCosts, MinimizeMakespan
from unified_planning.plans import ActionInstance, TimeTriggeredPlan
from unified_planning.shortcuts import (
    BoolType,
    ClosedTimeInterval,
    EndTiming,
    Equals,
    Fluent,
    GlobalStartTiming,
    Int,
    Not,
    StartTiming,
    UserType,
)

import serendipity
from serendipity.model import GroundAction, InputError, PlanError, Task, Timing, UsageError
from serendipity.testing.builders import task as build
from serendipity.testing.strategies.time import scripted_tasks, timed_tasks
from serendipity.up import from_problem, predict, to_plan, to_problem
from serendipity.up.engine import SerendipityEngine
from serendipity.up.plans import human_plan_of
from serendipity.up.reading import read
from tests.up.test_tasks_come_back import names

get_environment().credits_stream = None

OPTIONS: tuple[dict[str, object], ...] = (
    {"mode": "composite", "horizon": "inf", "interference": "strict"},
    {"mode": "individual"},
    {"mode": "serendipity", "discount": "3/5", "interference": "strict"},
    {"mode": "serendipity", "discount": "3/5", "window_weight": 0},
)


def valid(problem: Problem, plan: TimeTriggeredPlan) -> bool:
    return bool(TimeTriggeredPlanValidator().validate(problem, plan))


@pytest.mark.long
@given(timed_tasks(), st.sampled_from(OPTIONS))
def test_tasks_in_time_come_back_and_their_plans_are_valid(task: Task, options: dict[str, object]) -> None:
    assume(task.needs_time and not task.robot_goal)
    problem = to_problem(task)
    again = from_problem(problem, **names(task))
    before, after = serendipity.plan(task, **options), serendipity.plan(again, **options)
    assert (before.status, before.cost, before.objective) == (after.status, after.cost, after.objective)
    if after.plan is not None:
        assert valid(problem, to_plan(after, problem))


@pytest.mark.long
@given(scripted_tasks(), st.sampled_from(OPTIONS))
def test_plans_beside_timed_effects_are_valid_or_refused(task: Task, options: dict[str, object]) -> None:
    assume(task.script and not task.robot_goal)
    problem = to_problem(task)
    result = serendipity.plan(from_problem(problem, **names(task)), **options)
    try:
        plan = to_plan(result, problem)
    except PlanError as error:
        assert "in epochs only" in str(error)
        return
    assert plan is None or valid(problem, plan)


def kitchen() -> Problem:
    """Ann walks to the pantry, whose door opens at 8, and eats; the robot in there could bring it to her."""
    agent, place = UserType("Agent"), UserType("Place")
    person, helper = UserType("Person", agent), UserType("Helper", agent)
    problem = Problem("kitchen in time")
    at, food_at = Fluent("at", place, who=agent), Fluent("food_at", place)
    has_eaten, is_open = Fluent("has_eaten"), Fluent("is_open", BoolType(), at=place)
    hall, pantry, way = (Object(name, place) for name in ("Hall", "Pantry", "OnTheWay"))
    ann, robot = Object("Ann", person), Object("Robot", helper)
    problem.add_objects([hall, pantry, way, ann, robot])
    problem.add_fluents([at, food_at])
    for fluent in (has_eaten, is_open):
        problem.add_fluent(fluent, default_initial_value=False)
    for fluent, where in ((at(ann), hall), (at(robot), pantry), (food_at, pantry)):
        problem.set_initial_value(fluent, where)
    problem.set_initial_value(is_open(hall), True)
    problem.add_timed_effect(GlobalStartTiming(8), is_open(pantry), True)
    walk = DurativeAction("walk", who=agent, start=place, end=place)
    bring = DurativeAction("bring", who=helper, start=place, end=place)
    eat = DurativeAction("eat", who=person, where=place)
    for move, duration in ((walk, Fraction(3, 2)), (bring, Fraction(5, 2))):
        move.set_closed_duration_interval(duration, 10)
        move.add_condition(StartTiming(), Equals(at(move.who), move.start))
        move.add_condition(StartTiming(), Not(Equals(move.end, way)))
        move.add_effect(StartTiming(), at(move.who), way)
        move.add_effect(EndTiming(), at(move.who), move.end)
    walk.add_condition(StartTiming(), is_open(walk.end))
    bring.add_condition(StartTiming(), Equals(food_at, bring.start))
    bring.add_effect(EndTiming(), food_at, bring.end)
    eat.set_fixed_duration(2)
    eat.add_condition(ClosedTimeInterval(StartTiming(), EndTiming()), Equals(food_at, eat.where))
    eat.add_condition(ClosedTimeInterval(StartTiming(), EndTiming()), Equals(at(eat.who), eat.where))
    eat.add_effect(EndTiming(), has_eaten, True)
    problem.add_actions([walk, bring, eat])
    problem.add_goal(has_eaten)
    problem.add_quality_metric(MinimizeActionCosts({walk: 3, bring: 1, eat: 2}))
    return problem


def test_the_engine_tells_when_actions_begin() -> None:
    problem = kitchen()
    assert SerendipityEngine.supports(problem.kind)
    task = from_problem(problem, human="Ann", robots="Robot")
    assert {action.duration for action in task.actions} == {3, 4, 5}  # epochs of a half
    alone = SerendipityEngine(mode="individual", human="Ann", robots="Robot").solve(problem)
    assert [(str(a), float(d)) for _, a, d in alone.plan.timed_actions] == [
        ("walk(Ann, Hall, Pantry)", 1.5),
        ("eat(Ann, Pantry)", 2.0),
    ]
    assert float(alone.plan.timed_actions[0][0]) == pytest.approx(8, abs=0.01)
    best = SerendipityEngine(human="Ann", robots="Robot").solve(problem)
    assert (best.status, best.metrics["cost"]) == (Status.SOLVED_SATISFICING, "3.0")
    assert valid(problem, alone.plan)
    assert valid(problem, best.plan)
    given = human_plan_of(alone.plan, read(problem, "Ann", "Robot"))
    assert given == ((17, "walk ann hall pantry"), (20, "eat ann pantry"))


def test_a_team_in_time_is_one_of_the_library() -> None:
    """Its plans have agents, so the validator is given the same plan of a problem without them."""
    task = build(
        init="a", goal="c", robot_goal="d", actions={"x h": "a -> b", "y r": "b -> c !b", "z r": "a -> d"}
    )
    longer = replace(task, actions=tuple(map(lasting, task.actions)))
    team, single = to_problem(longer, multi_agent=True), to_problem(longer)
    assert SerendipityEngine.supports(team.kind)
    plan = SerendipityEngine(horizon="inf").solve(team).plan
    assert isinstance(plan, TimeTriggeredPlan)
    assert {one.agent.name for _, one, _ in plan.timed_actions} == {"h", "r"}
    objects = {thing.name: thing for thing in single.all_objects}
    same = [
        (start, ActionInstance(single.action(one.action.name), [objects[one.agent.name]]), takes)
        for start, one, takes in plan.timed_actions
    ]
    assert valid(single, TimeTriggeredPlan(same))


def lasting(action: GroundAction) -> GroundAction:
    """The action with a duration, whose deletions come at its start."""
    return replace(action, timing=Timing(3, start_delete=action.delete), delete=())


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (
            lambda p: p.action("eat").set_left_open_duration_interval(2, 3),
            "action 'eat': expected a least duration",
        ),
        (lambda p: p.action("eat").set_fixed_duration(0), "expected a duration above 0"),
        (
            lambda p: p.action("eat").add_effect(
                EndTiming(), p.fluent("is_open")(p.action("eat").where), True, p.fluent("has_eaten")
            ),
            "action 'eat': conditional effects of durative actions are not supported",
        ),
        (
            lambda p: p.action("eat").add_condition(StartTiming(1), p.fluent("has_eaten")),
            "INTERMEDIATE_CONDITIONS",
        ),
        (lambda p: p.add_timed_goal(GlobalStartTiming(9), p.fluent("has_eaten")), "TIMED_GOALS"),
        (lambda p: p.add_timed_effect(GlobalStartTiming(0), p.fluent("has_eaten"), True), "after the begin"),
        (
            lambda p: p.add_timed_effect(
                GlobalStartTiming(9), p.fluent("has_eaten"), True, p.fluent("has_eaten")
            ),
            "expected a fixed value and no condition",
        ),
        (
            lambda p: (p.clear_quality_metrics(), p.add_quality_metric(MinimizeMakespan())),
            "MAKESPAN: not supported",
        ),
        (
            lambda p: (
                p.clear_quality_metrics(),
                p.add_quality_metric(MinimizeActionCosts({p.action("eat"): Int(-4)})),
            ),
            "action 'eat .*cost",
        ),
    ],
)
def test_what_is_not_understood_is_refused(change: Callable[[Problem], object], why: str) -> None:
    problem = kitchen()
    change(problem)
    with pytest.raises(InputError, match=why) as error:
        from_problem(problem, human="Ann", robots="Robot")
    assert "\n" not in str(error.value)


def test_what_has_no_meaning_in_time_is_refused() -> None:
    problem = kitchen()
    task = from_problem(problem, human="Ann", robots="Robot")
    with pytest.raises(UsageError, match="predict_with: is for tasks in which no action takes time"):
        predict(task, "serendipity")
    engine = SerendipityEngine()
    engine.optimality_metric_required = True
    with pytest.raises(UPUsageError, match="in whole epochs only"):
        engine.solve(problem)
    plan = SerendipityEngine(mode="individual", human="Ann", robots="Robot").solve(problem).plan
    with pytest.raises(UPUsageError, match="time_triggered_plan_validator"):
        SerendipityEngine()._validate(problem, plan)
