"""Goals by what somebody began, where actions take time."""

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Condition, Script, Task, UsageError
from serendipity.testing.builders import task as build
from serendipity.testing.strategies.time import timed_tasks

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


def test_beside_a_script_it_is_refused() -> None:
    with pytest.raises(UsageError, match="time: the task has a script"):
        serendipity.recognise(LINE.with_script(Script(facts=[(2, "d")])), GOALS, ["go h a b"])
