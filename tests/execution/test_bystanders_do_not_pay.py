"""Robots that see to goals of their own, beside somebody who has to have nothing taken from them."""

from dataclasses import replace

import pytest

import serendipity
from serendipity.model import Condition, Script, Task
from serendipity.testing.builders import task as build

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
