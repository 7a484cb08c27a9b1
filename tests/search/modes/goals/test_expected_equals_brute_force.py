"""Each of several goals is served by the rules; with one goal it is section 3."""

from dataclasses import replace
from fractions import Fraction

from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search import PreparedTask
from search.engine.paths import plan_steps
from search.modes.scenarios import Candidate, solve_scenarios
from serendipity.model import Condition, Options, PlanStep, Result, Task
from serendipity.model.answers.answer import Answer, ServedGoal
from serendipity.testing.oracle import optimal_human_plan
from serendipity.testing.strategies import Call, calls
from tests.model.test_parts_of_results import rivals as rivals_at_work
from tests.search.modes.goals.strategies import literals, rivals
from verify.base.individual import IndividualOptimum
from verify.rules.case import Case
from verify.scenarios.timelines import Timeline, rule_fault

_OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0", "0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["1000", "0", "0.25", "1"]),
    interference=st.sampled_from(["paper", "strict"]),
    policy=st.just("fixed"),
)


def solve_expected(prepared: PreparedTask, options: Options, candidates: list[Candidate]) -> Answer:
    """The last answer."""
    *_, answer = solve_scenarios(prepared, options, candidates)
    return answer


@given(rivals(), _OPTIONS)
@settings(max_examples=25)
def test_each_goal_is_served_by_the_rules(rivalry: tuple[Task, list[Candidate]], options: Options) -> None:
    """Also those that are served at no gain; to the checker of section 3 they would be no opportunity."""
    task, candidates = rivalry
    answer = solve_expected(PreparedTask(task), options, candidates)
    for candidate, served in zip(candidates, answer.goals or (), strict=True):
        own = replace(task, goal=candidate.goal)
        robots = {s for s in served.steps if task.human not in task.actions[s.action].participants}
        assert robots == set(answer.steps or ())
        line = Timeline(
            "it",
            Fraction(1),
            Case(own, _as_result(own, options, candidate, served, answer), IndividualOptimum(own)),
        )
        assert [rule_fault(claim, [line]) for claim in ("replay", "cost", "window")] == [None] * 3
        if served.window is None:
            his = [s.action for s in served.steps if task.human in task.actions[s.action].participants]
            assert tuple(his) == candidate.plan
        elif served.cost >= task.cost_of(candidate.plan):
            _assert_needed(own, options, candidate, served, answer)


def _assert_needed(
    task: Task, options: Options, candidate: Candidate, served: ServedGoal, answer: Answer
) -> None:
    """A window that gains nothing for its own goal: the human's plan beside what robots do is no better.

    Robots do it for the sake of another goal.  Beside it the human's plan is impossible, or costs more,
    since the robots' work comes on top of it.
    """
    beside = tuple(sorted((*(answer.steps or ()), *plan_steps(candidate.plan))))
    cost = task.cost_of(candidate.plan) + sum(
        task.team_cost(task.actions[step.action], options.discount) for step in answer.steps or ()
    )
    alone = replace(served, steps=beside, window=None, cost=cost)
    line = Timeline(
        "it",
        Fraction(1),
        Case(task, _as_result(task, options, candidate, alone, answer), IndividualOptimum(task)),
    )
    length = options.window_weight * (len(served.window) - 1)
    assert rule_fault("replay", [line]) or cost >= served.cost + length


def test_a_goal_served_at_no_gain() -> None:
    """Lifting saves 8 if the human wants p; for z they can't ``keep`` beside it but have to ``mend``."""
    goals = [{"name": "p", "goal": ["p"]}, {"name": "z", "goal": ["z"]}]
    answer = serendipity.plan(rivals_at_work(), goals=goals, horizon=3, interference="strict")
    p, z = answer.goals or ()
    assert (answer.opportunity, p.cost, z.cost) == (True, 1.0, 5.0)
    assert z.window is not None
    assert [step.action for step in z.plan or ()] == ["lift r", "mend h"]


@given(calls(modes=("serendipity",), ties=False))
def test_one_goal_is_section_3(call: Call) -> None:
    task = call.task
    named = [{"name": "it", "goal": literals(task, task.goal)}]
    options = {**call.options.to_dict()}
    plain = serendipity.plan(task, **options)
    answer = serendipity.plan(task, goals=named, **options)
    expected, got = plain.to_dict(), answer.to_dict()
    expected.pop("statistics"), got.pop("statistics")
    if plain.reason == "no-human-plan":
        assert (answer.status, answer.reason) == ("infeasible", "no-human-plan")
    else:
        assert got == expected


@given(calls(modes=("serendipity",), ties=False))
def test_the_search_by_itself_is_section_3_with_one_goal(call: Call) -> None:
    task, options = replace(call.task, robot_goal=Condition()), call.options.but(max_cost=None)
    plan = call.human_plan or optimal_human_plan(task)
    if plan is None:
        return
    one = solve_expected(PreparedTask(task), options, [Candidate(task.goal, plan, Fraction(1))])
    names = [task.actions[i].name for i in plan]
    known = serendipity.plan(task, human_plan=names, **options.to_dict())
    assert (float(one.cost), one.opportunity) == (known.cost, known.opportunity)
    assert float(one.objective) == known.objective


def _as_result(
    task: Task, options: Options, candidate: Candidate, served: ServedGoal, answer: Answer
) -> Result:
    """What happens for one goal, ready to be checked."""
    steps = []
    for step in served.steps:
        action = task.actions[step.action]
        cost = task.team_cost(action, options.discount)
        names = tuple(task.agents[i] for i in action.participants)
        steps.append(PlanStep(step.epoch, names, action.name, float(cost)))
    return Result(
        mode="serendipity",
        status="feasible",
        human=task.agents[task.human],
        options=options.but(horizon=answer.horizon),
        human_plan=tuple(task.actions[i].name for i in candidate.plan),
        cost=float(served.cost),
        horizon=answer.horizon,
        window=served.window,
        plan=tuple(steps),
    )
