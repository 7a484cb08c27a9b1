"""Policies in time: durations, a script, bystanders, plans with waiting (semantics 11)."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from search.modes.scenarios import Candidate
from serendipity import plan, verify
from serendipity.facade.results import named_plan
from serendipity.model import Condition, HumanPlan, Options, PlanError, Task
from serendipity.model.task.plans_in_time import outlasts
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import human_plans
from serendipity_testing.oracle.scenarios import best_policy
from serendipity_testing.strategies.time import scripts, tasks_in_time, timed_plans, timed_tasks
from tests.search.modes.scenarios.strategies import options_over, turning_tasks

_LONGEST = 6
_PLAIN = {"suffix": "replan", "preservation": "kernel"}


@st.composite
def turning_in_time(draw: st.DrawFn) -> Task:
    """Somebody turns off somewhere, actions take time, and now and then there is a script."""
    task = draw(timed_tasks(of=turning_tasks()))
    return task.with_script(draw(scripts(task, most=2))) if draw(st.booleans()) else task


@st.composite
def calls_in_time(draw: st.DrawFn) -> tuple[Task, list[Candidate], Options] | None:
    """A call over two or three scenarios, or over one; None where there are none that are short enough."""
    turning = draw(st.booleans())
    task = replace(draw(turning_in_time() if turning else tasks_in_time()), robot_goal=Condition())
    shares = draw(st.sampled_from([(1,), (1, 1), (1, 3), (9, 1), (1, 2, 3)]))
    found: list[Candidate] = []
    for number, share in enumerate(shares):
        own = f"x{number}"
        known = (aimed_plan(task, fact) for fact in ([own] if turning else draw(st.permutations(task.facts))))
        aimed, best = next((pair for pair in known if pair is not None), (task, None))
        if best is None:
            return None
        chosen = aimed.plan_from_names(named_plan(aimed, draw(timed_plans(aimed, best))))
        found.append(Candidate(aimed.goal, chosen, Fraction(share, sum(shares)), f"s{number}"))
    options = draw(options_over(found)).but(**_PLAIN)
    longest = max(task.epochs_of(one.plan) for one in found)
    options = options.but(horizon=None if options.horizon is None else longest + draw(st.integers(0, 1)))
    if len(found) == 1 and options.risk == "regret":
        options = options.but(risk="mean")  # one scenario is an ordinary call, which knows no risk
    horizon = int(options.horizon or longest)
    if not longest or horizon > (_LONGEST if len(found) < 3 else 5) or len(task.actions) * horizon > 60:
        return None
    return (task, found, options) if all(lasts(task, one, options, horizon) for one in found) else None


def lasts(task: Task, one: Candidate, options: Options, horizon: int) -> bool:
    """Whether a plan works, and what it reaches lasts."""
    try:
        return outlasts(task.with_goal(one.goal), one.plan, horizon, strict=options.strict) is None
    except PlanError:  # strict interference
        return False


def aimed_plan(task: Task, fact: str) -> tuple[Task, HumanPlan] | None:
    """The task with one fact as goal, and a plan to it; None where they do nothing for it."""
    aimed = task.with_goal(Condition((task.facts.index(fact),))) if fact in task.facts else None
    plan = None if aimed is None else next(human_plans(aimed), None)
    if aimed is None or not plan:
        return None
    # A plan in a library ends with its last action.
    if task.epochs_of(plan) != task.starts_of(plan)[-1] + task.actions[plan[-1]].duration - 1:
        return None
    return aimed, plan


def library(task: Task, candidates: list[Candidate]) -> list[dict[str, object]]:
    """The scenarios as the plans of a library."""
    return [
        {
            "name": one.name,
            "probability": str(one.weight),
            "goal": list(one.goal.literals(task.facts)),
            "plan": list(named_plan(task.with_goal(one.goal), one.plan)),
        }
        for one in candidates
    ]


@pytest.mark.long
@given(calls_in_time())
@settings(max_examples=60)
def test_search_equals_brute_force(call: tuple[Task, list[Candidate], Options] | None) -> None:
    if call is None:
        return
    task, candidates, options = call
    best = best_policy(task, options, candidates, int(options.horizon) if options.horizon else None)
    asked = {name: getattr(options, name) for name in Options.__dataclass_fields__}
    answer = plan(task, plans=library(task, candidates), **asked)
    assert answer.status == "optimal"
    assert (answer.objective, answer.cost) == (float(best.objective), float(best.cost))
    assert (answer.opportunity, answer.human_cost) == (best.opportunity, float(best.baseline))
    if options.risk == "mean" and len(candidates) > 1:
        costs = (one.weight * Fraction(str(s.cost)) for one, s in zip(candidates, answer.goals, strict=True))
        assert float(sum(costs, Fraction(0))) == pytest.approx(answer.cost)


def test_robots_end_what_they_are_at_and_that_costs() -> None:
    """The robot has begun to open before it is told that nobody comes by."""
    task = build(
        init="at0",
        actions={
            "walk h": "at0 -> at1 !at0 @ 1",
            "slow h": "at1 -> at2 !at1 @ 9",
            "jump h": "at0 open -> at2 !at0 @ 0",
            "open r": "-> open @ 1 [3]",
        },
    )
    goals = {"far": ("at2", [[2, "walk h"], [3, "slow h"]]), "near": ("at1", ["walk h"])}
    plans = [
        {"name": name, "probability": 0.5, "goal": [fact], "plan": steps}
        for name, (fact, steps) in goals.items()
    ]
    answer = plan(task, plans=plans, horizon=4, discount="0.5", window_weight=1)
    assert [one.cost for one in answer.goals] == [0.5, 1.5]
    assert (answer.cost, answer.status) == (1.0, "optimal")


@pytest.mark.parametrize("risk", ["mean", "worst", "regret"])
def test_what_is_left_is_paid_for_in_each_scenario(risk: str) -> None:
    """Who wants nothing does nothing beside help, and leaves `b` false."""
    walk, lift = "-> b @ 2 [2]", "-> b @ 0.5 [2]"
    task = build(goal="b", actions={"walk h": walk, "lift h r": lift, "on r": "!l -> l", "off r": "l -> !l"})
    plans = [
        {"probability": 1, "plan": ["walk h"], "goal": []},
        {"probability": 1, "plan": [[2, "walk h"]]},
    ]
    answer = plan(task, plans=plans, risk=risk, leave_price="*=0.25", discount=1, window_weight=0)
    assert [one.cost for one in answer.goals] == [0.25, 0.5]
    assert verify(task, answer).verdict == "proved"
