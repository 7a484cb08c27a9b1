"""Robots that see to goals of their own, or have to leave things as they would be: nobody pays for that."""

from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity import Condition, Script, Task
from serendipity_testing import strategies
from serendipity_testing.builders import task as build

PERSONS = ("observant", "local", "omniscient")


def kitchen(wants: str, *, epoch: int = 3) -> Task:
    """Robots are to have the cup washed, which Carol is going to drink from, or wants to be where it is."""
    built = build(
        agents="ann bot carol",
        human="ann",
        init="at0 cup",
        goal="at2",
        robot_goal="washed",
        actions={
            "walk1 ann": "at0 -> at1 !at0",
            "walk2 ann": "at1 -> at2 !at1",
            "wash bot": "-> washed !cup",
            "wash-up bot": "-> washed @ 5",
            "sit carol": "-> seated",
            "drink carol": "cup seated -> drunk",
        },
    )
    goal = Condition((built.facts.index(wants),))
    built = replace(built, own_goals=((2, goal),), known_variables=built.variables)
    plan = [(1, "sit carol")] if wants == "cup" else [(1, "sit carol"), (epoch, "drink carol")]
    return built.with_script(Script(people={"carol": plan}))


def done(task: Task, person: str) -> list[str]:
    """What robots do."""
    (log,) = serendipity.execute(task, person, discount="0.5").logs
    steps = [step for line in log for step in line.get("steps", ())]
    return [step["action"] for step in steps if "ann" not in step["agents"]]


@pytest.mark.parametrize("person", PERSONS)
@pytest.mark.parametrize("wants", ["cup", "drunk"])
def test_what_a_bystander_needs_is_left_to_them(wants: str, person: str) -> None:
    """It was taken: beside who is not told, and once Ann was there, nobody thought of Carol."""
    task = kitchen(wants, epoch=8)
    without = tuple(action for action in task.actions if action.name != "wash-up bot")
    harmful = replace(task, actions=without, known_variables=task.variables)
    assert "wash bot" not in [*done(task, person), *done(harmful, person)]


@pytest.mark.parametrize("person", PERSONS)
def test_what_nobody_needs_any_more_may_be_taken(person: str) -> None:
    assert done(kitchen("drunk", epoch=2), person) == ["wash bot"]


@pytest.mark.parametrize("person", PERSONS)
def test_what_robots_take_with_the_end_of_a_long_action_is_taken(person: str) -> None:
    """The epoch in which it begins was looked at only, when Carol has the cup still."""
    built = build(
        agents="ann bot carol",
        human="ann",
        init="at0 cup",
        goal="at1",
        robot_goal="washed",
        actions={
            "walk ann": "at0 -> at1 !at0",
            "wash bot": "seated -> washed / !cup [2]",
            "sit carol": "-> seated",
        },
    )
    wants = Condition((built.facts.index("cup"),))
    built = replace(built, own_goals=((2, wants),), known_variables=built.variables)
    assert (
        done(built.with_script(Script(people={"carol": [(2, "sit carol"), (3, "sit carol")]})), person) == []
    )


@pytest.mark.long
@given(
    strategies.tasks(),
    st.sampled_from(["omniscient", "observant", "local"]),
    st.sampled_from(["at*", "none", "*0*"]),
)
def test_nothing_is_left_and_nobody_pays(task: Task, human: str, free: str) -> None:
    assume(not task.robot_goal and serendipity.plan(task, mode="individual").cost is not None)
    (run,) = serendipity.execute(task, human, discount="0.9", leave_free=free).rows
    assert run.reached and run.left == 0
    assert run.alone is not None and run.human_cost <= run.alone


def test_the_cart_is_brought_back() -> None:
    task = serendipity.example("parcels")
    runs = {
        free: serendipity.execute(task, "omniscient", discount="0.9", leave_free=free).rows[0]
        for free in ("*", "at *", None, "nothing")
    }
    assert [float(f"{run.cost:.6g}") for run in runs.values()] == [8.5, 8.6, 8.7, 8.8]
    assert {run.human_cost for run in runs.values()} == {8}


def test_robots_with_goals_of_their_own_leave_what_these_ask_for() -> None:
    task = serendipity.example("parcels")
    own = task.with_goal(task.goal, Condition((task.facts.index("at cart mill"),)))
    (run,) = serendipity.execute(own, "omniscient", discount="0.9").rows
    assert run.reached


def test_what_somebody_wants_is_not_put_back() -> None:
    """Goals were contradictory: the crate brought and at home, or a cup that only a robot gives, and not."""
    fetch = {"go h": "a -> b !a", "fetch r": "home -> crate !home", "back r": "crate -> home !crate"}
    give = {"give h r": "desk -> cup", "drop r": "tray -> floor !tray", "pick r": "floor -> tray !floor"}
    for task in (
        build(agents="h r", human="h", init="a home", goal="b", robot_goal="crate", actions=fetch),
        build(agents="h r", human="h", init="desk tray", goal="cup", actions=give),
    ):
        (run,) = serendipity.execute(task, "omniscient", discount="0.9", leave_free="nothing").rows
        assert (run.reached, run.left) == (True, 0)
