"""Robots in time who don't know what the person wants, or know their habits (semantics 8, 10.6 and 11)."""

from itertools import islice
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import Execution, person_of
from serendipity.model import Condition, PlanError, Script, Task, UsageError
from serendipity_testing.builders import Builder
from serendipity_testing.oracle import human_plans
from serendipity_testing.strategies.time import tasks_in_time
from tests.execution.living import arrives, lived, other_goals, replayed, verdicts

DISCOUNTS = st.sampled_from(["0", "0.5", "0.9", "1"])
UP, REST = {"name": "up", "goal": ["above"]}, {"name": "rest", "goal": ["rested"]}


def _house(goal: str = "above") -> Task:
    """Ann goes to the box and carries it up, or rests; Bob can bring it up meanwhile."""
    made = Builder(("ann", "bob"))
    made.named("walk ann", (0,), "home", "hall !home", "1", 2)
    made.named("carry ann", (0,), "hall below free / below /", "above !below", "6", 4)
    made.named("drag ann", (0,), "hall below", "above !below", "9", 3)
    made.named("bring bob", (1,), "below free / free / free", "above !below", "2", 2)
    made.named("nap ann", (0,), "home", "rested", "2", 3)
    made.named("shut bob", (1,), "", "!free", "0")
    return made.task("below free home", goal)


@pytest.mark.parametrize("human", ["observant", "omniscient"])
def test_robots_see_what_she_begins_before_they_do(human: str) -> None:
    runs = serendipity.execute(_house(), human, discount="0.5", goals=[UP, REST])
    (row,) = runs.rows
    assert (row.reached, row.wrong, row.cost) == (True, 0, 2)
    first = runs.logs[0][1]
    assert (first["decision"]["verdict"], first["steps"][0]["action"]) == ("unsure", "walk ann")
    (rests,) = serendipity.execute(_house("rested"), human, discount="0.5", goals=[UP, REST]).rows
    assert (rests.reached, rests.cost, rests.helped) == (True, 2, 0)


def test_the_posterior_weighs_what_was_begun_by_where_it_leads() -> None:
    run = Execution(_house(), discount="0", goals=[UP, {"name": "home", "goal": ["home"]}])
    run.step("walk ann")  # 1 too much for whoever wants to stay at home, and nothing leads back
    assert run.decided.goals == {"up": 1, "home": 0}
    both = Execution(_house(), discount="0", goals=[UP, {"name": "there", "goal": ["hall"]}])
    both.step("walk ann")
    assert set(both.decided.goals.values()) == {0.5}, "what Bob has begun meanwhile tells nothing of her"


def _habit(name: str, probability: float, *plan: tuple[int, str], goal: str = "above") -> dict[str, Any]:
    return {"name": name, "probability": probability, "plan": list(plan), "goal": [goal]}


CARRY = _habit("carry", 1, (1, "walk ann"), (4, "carry ann"))
DRAG = _habit("drag", 1, (1, "walk ann"), (3, "drag ann"))


def test_habits_are_kept_however_dear_and_late() -> None:
    run = Execution(_house(), discount="0", plans=[CARRY, DRAG])
    run.step(None)
    assert run.decided.goals == {"carry": 0.5, "drag": 0.5}, "who is late"
    run.step("walk ann")
    run.step(None)
    run.step("drag ann")
    assert run.decided.goals == {"carry": 0, "drag": 1}
    run.step(None)
    run.step(None)
    assert run.done and run.human_cost == 10


def test_a_habit_is_not_spoilt() -> None:
    """Bob could shut the way at no cost, as a cheap way is left by which nobody goes."""
    made = Builder(("ann", "bob"))
    made.named("round ann", (0,), "free", "there", "5")
    made.named("over ann", (0,), "", "there", "1")
    made.named("shut bob", (1,), "", "!free", "0")
    made.named("help bob", (1,), "!free", "there", "1", 2)
    task = made.task("free", "there")
    plans = [_habit("round", 1, (4, "round ann"), goal="there")]
    run = Execution(task, discount="1", plans=plans)
    assert run.decided.alone is None or run.decided.actions == ()
    for name in (None, None, None, "round ann"):
        run.step(name)
    assert run.done


def test_none_left_of_a_library_leaves_its_goals() -> None:
    run = Execution(_house(), discount="0", plans=[CARRY, _habit("nap", 1, (1, "nap ann"), goal="rested")])
    run.step("walk ann")
    assert run.decided.goals == {"carry": 1, "nap": 0}
    run.step(None)
    run.step("drag ann")
    assert set(run.decided.goals) == {"carry", "nap"} and lived(run, person_of(run.task)).done


def test_who_is_told_gets_the_rest_of_the_policy() -> None:
    run = Execution(_house(), discount="0.9", goals=[UP, REST], told=True)
    person = person_of(run.task, "omniscient")
    lived(run, person)
    promised = serendipity.plan(_house(), discount="0.9", goals=[UP, REST])
    (up, _) = promised.goals or ()
    assert float(run.cost) == up.cost
    assert verdicts(run)[0] in ("unsure", "helps")


def test_a_goal_may_come_by_itself() -> None:
    """It was an error that it does not hold with no step."""
    made = Builder(("ann", "bob"))
    made.named("climb ann", (0,), "", "above", "3", 2)
    made.named("toll bob", (1,), "", "rung", "1")
    task = made.task("", "above").with_script(Script(facts=[(3, "rung")]))
    goals = [UP, {"name": "rung", "goal": ["rung"]}]
    run = Execution(task, goals=goals, told=True)
    assert lived(run, person_of(task, "omniscient")).done and run.human_cost == 3


@pytest.mark.long
@given(tasks_in_time(), DISCOUNTS, st.integers(0, 2**32), st.sampled_from(["told", "observant", "drawn"]))
def test_nobody_pays_whose_goal_is_not_known(task: Task, discount: str, seed: int, human: str) -> None:
    task, dice = task.with_goal(task.goal, Condition()), Random(seed)
    _costs_nothing(task, human, dice, discount=discount, goals=other_goals(task, dice))


@pytest.mark.long
@given(tasks_in_time(), DISCOUNTS, st.integers(0, 2**32), st.sampled_from(["told", "observant"]))
def test_nobody_pays_whose_habits_are_known(task: Task, discount: str, seed: int, human: str) -> None:
    task, dice = task.with_goal(task.goal, Condition()), Random(seed)
    plans = []
    for one in other_goals(task, dice):
        literals = one["goal"]
        assert isinstance(literals, list)
        ids = [(task.facts.index(text.lstrip("!")), text[0] != "!") for text in literals]
        goal = Condition(*(tuple(sorted(f for f, true in ids if true is want)) for want in (True, False)))
        aimed = task.with_goal(goal)
        for number, plan in enumerate(islice(human_plans(aimed), 2)):
            done = list(zip(aimed.starts_of(plan), (task.actions[i] for i in plan), strict=True))
            steps, end = [(start, action.name) for start, action in done], aimed.epochs_of(plan)
            if all(start + action.duration <= end for start, action in done) and end:
                steps.append((end, "noop"))  # others bring the goal about
            plans.append(_habit(f"{one['name']} {number}", 1, *steps) | {"goal": literals})
    try:
        _costs_nothing(task, human, dice, discount=discount, plans=plans)
    except (PlanError, serendipity.InputError):
        assert not all(one["plan"] for one in plans) or not plans, "a goal that comes by itself is no plan's"


def _costs_nothing(task: Task, human: str, dice: Random, **asked: Any) -> None:
    """Live through a day: the person arrives and pays no more than alone, nobody is disturbed, it replays."""
    if next(human_plans(task), None) is None:
        return
    told = human == "told"
    run = Execution(task, told=told, **asked)
    who = "omniscient" if told else "observant"
    arrives(task, run, person_of(task, who, dice if human == "drawn" else None))
    replayed(task, run)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"goals": [UP], "noise": "miss=0.1"}, "noise: in time"),
        ({"goals": [UP], "told": True, "mode": "communication"}, "goals and plans: in time"),
    ],
)
def test_what_goals_in_time_go_without(asked: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        Execution(_house(), **asked)
    with pytest.raises(UsageError, match="without robots' own goals"):
        Execution(_house().with_goal(_house().goal, Condition((0,))), goals=[UP])
