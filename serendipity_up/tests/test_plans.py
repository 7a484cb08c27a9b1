"""Plans of the library, both ways.

Durative actions and timed effects are read as our own, and plans are those of the library's validator.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from unified_planning.engines import PlanGenerationResultStatus, SequentialPlanValidator
from unified_planning.engines import PlanGenerationResultStatus as Status
from unified_planning.engines.plan_validator import TimeTriggeredPlanValidator
from unified_planning.environment import get_environment
from unified_planning.exceptions import UPUsageError
from unified_planning.model import DurativeAction, Object, Problem
from unified_planning.model.metrics import MinimizeActionCosts, MinimizeMakespan
from unified_planning.plans import (
    ActionInstance,
    ContingentPlan,
    PartialOrderPlan,
    PlanKind,
    SequentialPlan,
    TimeTriggeredPlan,
)
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
from serendipity_testing.builders import task as build
from serendipity_testing.strategies.time import scripted_tasks, timed_tasks
from serendipity_up import EpochPlan, from_problem, predict, to_plan, to_problem
from serendipity_up.engine import SerendipityEngine
from serendipity_up.plans import human_plan_of
from serendipity_up.reading import read
from serendipity_up.tests.problems import corridor, kitchen
from serendipity_up.tests.test_tasks_come_back import names

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


def kitchen_in_time() -> Problem:
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
    problem = kitchen_in_time()
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
    problem = kitchen_in_time()
    change(problem)
    with pytest.raises(InputError, match=why) as error:
        from_problem(problem, human="Ann", robots="Robot")
    assert "\n" not in str(error.value)


def test_what_has_no_meaning_in_time_is_refused() -> None:
    problem = kitchen_in_time()
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
