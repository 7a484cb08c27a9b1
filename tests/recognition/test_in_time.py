"""Goals by what somebody began, where actions take time."""

from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity.model import Condition, Script, Task, UsageError
from serendipity.testing.builders import task as build
from serendipity.testing.oracle.observed import costs_of_observed
from serendipity.testing.oracle.scenarios import best_policy
from serendipity.testing.strategies.time import tasks_in_time, timed_tasks

WAYS = {
    "go h a b": "a -> b !a @ 1 [3]",
    "go h b c": "b -> c !b @ 1 [2]",
    "go h a d": "a -> d !a @ 1",
    "go h a c": "a -> c !a @ 4 [4]",
}
LINE = build(init="a", goal="c", actions=WAYS)
GOALS = [{"name": name, "goal": [name]} for name in "cd"]


def test_what_was_begun_tells_goals_apart() -> None:
    known = serendipity.recognise(LINE, GOALS, ["go h a b"])
    c, d = known.goals
    assert (c.posterior, d.posterior) == (1, 0)
    assert (c.with_observed, c.without_observed, c.plan) == (2, 4, ("go h a b", "go h b c"))
    quick = build(init="a", goal="c", actions={name: text.split(" [")[0] for name, text in WAYS.items()})
    noisy = {"observed": ["go h a c", "go h b c"], "noise": "wrong=0.1"}
    assert (
        serendipity.recognise(LINE, GOALS, **noisy).goals
        == serendipity.recognise(quick, GOALS, **noisy).goals
    )


@pytest.mark.long
@given(timed_tasks(), st.randoms(use_true_random=False))
def test_costs_are_those_of_plans_in_time(task: Task, dice: Random) -> None:
    task = replace(task, robot_goal=Condition(), known_variables=task.variables)
    seen = [task.actions[dice.choice(task.human_actions)].name] if task.human_actions else []
    goals = [{"name": fact, "goal": [fact]} for fact in task.facts[:3]]
    for one in serendipity.recognise(task, goals, seen).goals:
        aimed = task.with_goal(Condition((task.facts.index(one.name),)))
        costs = [cost for cost in (one.with_observed, one.without_observed) if cost is not None]
        alone = serendipity.plan(aimed, mode="individual").cost
        assert (float(min(costs)) if costs else None) == alone


SHOP = build(
    init="a",
    goal="c",
    actions={
        "go h a b": "a -> b !a @ 1",
        "go h a c": "a -> c !a @ 3",
        "enter h": "b open -> c !b @ 1",
        "go h a d": "a -> d !a @ 1",
    },
).with_script(Script(facts=[(3, "open")]))
"""It opens with epoch 3; who is at the door before waits."""


def test_who_goes_to_a_closed_shop_waits_until_it_opens() -> None:
    c, d = serendipity.recognise(SHOP, GOALS, ["go h a b"]).goals
    assert (c.with_observed, c.without_observed, d.with_observed) == (2, 3, None)
    answer = serendipity.plan(SHOP, goals=GOALS, observed=["go h a b"])
    assert answer.human_entries == ((1, "go h a b"), (4, "enter h"))
    assert [one.posterior for one in answer.recognition.goals] == [1, 0]
    with pytest.raises(UsageError, match="noise: where a script or durations count"):
        serendipity.recognise(SHOP, GOALS, ["go h a b"], noise="miss=0.1")


@pytest.mark.long
@settings(max_examples=settings().max_examples // 5)
@given(tasks_in_time(), st.randoms(use_true_random=False))
def test_costs_and_answers_equal_brute_force(task: Task, dice: Random) -> None:
    task = replace(task, robot_goal=Condition(), known_variables=task.variables)
    own = [task.actions[i].name for i in task.human_actions]
    seen = [dice.choice(own) for _ in range(dice.choice((1, 2)))] if own else []
    goals = [{"name": fact, "goal": [fact]} for fact in task.facts[:3]]
    aims = [Condition((fact,)) for fact in range(len(goals))]
    found = serendipity.recognise(task, goals, seen)
    for aim, one in zip(aims, found.goals if seen else (), strict=False):
        assert (one.with_observed, one.without_observed) == costs_of_observed(task, aim, seen)
    try:
        answer = serendipity.plan(task, goals=goals, observed=seen, discount=0.5, nobody_pays=False)
    except UsageError:
        return  # what a plan reaches does not last
    scenarios = []
    for entry in answer.goals or ():
        aim, times = aims[task.facts.index(entry.name)], entry.human_plan_times
        names = entry.human_plan if times is None else times.entries(entry.human_plan)
        plan = task.with_goal(aim).plan_from_names(names)
        scenarios.append(Candidate(aim, plan, Fraction(entry.probability)))
        (known,) = (one for one in found.goals if one.name == entry.name)
        assert not found.explained or task.cost_of(plan) == known.with_observed
    if len(scenarios) > 1:
        assert answer.cost == pytest.approx(float(best_policy(task, answer.options, scenarios).cost))
