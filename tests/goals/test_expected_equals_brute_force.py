"""The robots' plan for several goals is the best one; with one goal it is section 3."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search.goals import Candidate, Served, solve_expected
from search.goals.planner import _Search
from serendipity.model import Condition, GroundAction, Options, PlanStep, Result, Step, Task
from tests.goals.oracle import best_expected, robots_sets
from tests.goals.strategies import literals, rivals
from tests.oracle import optimal_human_plan
from tests.strategies import Call, calls

_MOST_PLANS = 300
_OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0", "0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["1000", "0", "0.25", "1"]),
    interference=st.sampled_from(["paper", "strict"]),
)


@pytest.fixture
def unguided(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search without what the answers for single goals tell it."""
    monkeypatch.setattr(_Search, "_floor", lambda *_: (0, 0))
    monkeypatch.setattr(_Search, "_own_actions", lambda *_: {})


@given(rivals(), _OPTIONS)
@settings(max_examples=40)
def test_two_goals(rivalry: tuple[Task, list[Candidate]], options: Options) -> None:
    task, candidates = rivalry
    horizon = max(len(candidate.plan) for candidate in candidates)
    if len(robots_sets(task, strict=options.strict)) ** horizon > _MOST_PLANS:
        horizon = 0  # too many for brute force: only the laws below are checked
    answer = solve_expected(task, options, candidates)
    assert answer.status == "optimal"
    assert answer.cost <= answer.baseline
    assert sum(c.weight * s.cost for c, s in zip(candidates, answer.served, strict=True)) == answer.cost
    if horizon:
        objective, cost = best_expected(task, options, candidates, horizon)
        idle = solve_expected(
            replace(task, actions=_without_robots(task)), options, _renamed(task, candidates)
        )
        helps = cost < idle.cost
        assert answer.opportunity == helps
        assert (answer.objective, answer.cost) == ((objective, cost) if helps else (idle.cost, idle.cost))


@given(rivals(), _OPTIONS)
@settings(max_examples=25)
def test_each_goal_is_served_by_the_rules(rivalry: tuple[Task, list[Candidate]], options: Options) -> None:
    task, candidates = rivalry
    answer = solve_expected(task, options, candidates)
    for candidate, served in zip(candidates, answer.served, strict=True):
        own = replace(task, goal=candidate.goal)
        together = {s for s in served.steps if task.human not in task.actions[s.action].participants}
        assert together == set(answer.robots)
        if served.window is None:
            assert _replayed(own, served.steps, answer.horizon)
            his = [s.action for s in served.steps if task.human in task.actions[s.action].participants]
            assert tuple(his) == candidate.plan
            continue
        if served.cost >= task.cost_of(candidate.plan):
            continue  # dear for this goal, for the sake of another: section 3 would not answer so
        certificate = serendipity.check(own, _as_result(own, options, candidate, served, answer.horizon))
        verdicts = {claim.claim: (claim.verdict, claim.reason) for claim in certificate.claims}
        for claim in ("replay", "cost", "window"):
            assert verdicts[claim][0] == "proved", verdicts


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


@pytest.mark.usefixtures("unguided")
def test_the_search_by_itself_is_section_3_with_one_goal() -> None:
    @given(calls(modes=("serendipity",), ties=False))
    def law(call: Call) -> None:
        task, options = replace(call.task, robot_goal=Condition()), call.options.but(max_cost=None)
        plan = call.human_plan or optimal_human_plan(task)
        if plan is None:
            return
        one = solve_expected(task, options, [Candidate(task.goal, plan, Fraction(1))])
        names = [task.actions[i].name for i in plan]
        known = serendipity.plan(task, human_plan=names, **options.to_dict())
        assert (float(one.cost), one.opportunity) == (known.cost, known.opportunity)
        assert float(one.objective) == known.objective

    law()


@pytest.mark.usefixtures("unguided")
def test_the_answers_for_single_goals_only_save_time() -> None:
    @given(rivals(), _OPTIONS)
    @settings(max_examples=12)
    def law(rivalry: tuple[Task, list[Candidate]], options: Options) -> None:
        task, candidates = rivalry
        unguided = solve_expected(task, options, candidates)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(_Search, "_floor", _FLOOR)
            patch.setattr(_Search, "_own_actions", _OWN_ACTIONS)
            guided = solve_expected(task, options, candidates)
        assert (guided.objective, guided.cost) == (unguided.objective, unguided.cost)

    law()


_FLOOR, _OWN_ACTIONS = _Search._floor, _Search._own_actions


def _without_robots(task: Task) -> tuple[GroundAction, ...]:
    return tuple(action for action in task.actions if action.participants == (task.human,))


def _renamed(task: Task, candidates: list[Candidate]) -> list[Candidate]:
    """The candidates over a task that has only what the human does alone."""
    index = {action: i for i, action in enumerate(task.human_actions)}
    return [replace(c, plan=tuple(index[action] for action in c.plan)) for c in candidates]


def _replayed(task: Task, steps: tuple[Step, ...], horizon: int) -> bool:
    state = task.init
    for epoch in range(1, horizon + 1):
        actions = [task.actions[s.action] for s in steps if s.epoch == epoch]
        assert all(action.applicable(state) for action in actions)
        gone = {f for action in actions for f in action.delete}
        state = frozenset((state - gone) | {f for action in actions for f in action.add})
    return task.goal.holds(state)


def _as_result(task: Task, options: Options, candidate: Candidate, served: Served, horizon: int) -> Result:
    """What happens for one goal as an answer of section 3, ready to be checked."""
    shares = dict.fromkeys(task.agents, Fraction(0))
    steps = []
    for step in served.steps:
        action = task.actions[step.action]
        cost = task.team_cost(action, options.discount)
        names = tuple(task.agents[i] for i in action.participants)
        steps.append(PlanStep(step.epoch, names, action.name, float(cost)))
        for name in names:
            shares[name] += cost / len(names)
    assert served.window is not None
    objective = float(served.cost + options.window_weight * len(served.window))
    baseline = task.cost_of(candidate.plan)
    return Result(
        mode="serendipity",
        status="feasible",
        human=task.agents[task.human],
        options=options.but(horizon=horizon),
        human_plan=tuple(task.actions[i].name for i in candidate.plan),
        human_cost=float(baseline),
        opportunity=served.cost < baseline,
        cost=float(served.cost),
        saving=float(baseline - served.cost),
        objective=objective,
        lower_bound=0.0,
        horizon=horizon,
        window=served.window,
        saving_alone=0.0,
        plan=tuple(steps),
        agent_costs={name: float(cost) for name, cost in shares.items()},
    )
