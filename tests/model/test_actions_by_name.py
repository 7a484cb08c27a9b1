"""Actions are found by name where they stand; a task with another goal keeps what that can not change."""

from hypothesis import given

import serendipity
from serendipity.model import Condition, Task
from serendipity.testing.builders import task as build
from serendipity.testing.strategies import Call, calls


@given(calls(modes=("composite",), ties=False))
def test_every_name_leads_to_its_actions(call: Call) -> None:
    expected: dict[str, tuple[int, ...]] = {}
    for i, action in enumerate(call.task.actions):
        expected[action.name] = (*expected.get(action.name, ()), i)
    assert dict(call.task.named) == expected
    assert len(call.task.named) == len(expected)
    for name in ("", "a", "zz", "no such action", *(f"{name} x" for name in expected)):
        assert name not in call.task.named


def test_names_are_compared_part_by_part() -> None:
    names = ["a", "a b", "a b c", "a-b", "a! c", "b"]
    task = build(goal="g", actions={f"{name} h": "-> g" for name in names})
    assert [action.key for action in task.actions] == sorted(action.key for action in task.actions)
    for name in names:
        (found,) = task.named[f"{name} h"]
        assert task.actions[found].name == f"{name} h"


def test_another_goal_keeps_the_variables() -> None:
    """They were found again for each goal, which took longer than a short limit."""
    task = serendipity.example("room2")
    other = task.with_goal(Condition((0,)), Condition())
    assert other.variables is task.variables
    assert other.goal == Condition((0,))
    assert other == Task(
        task.name,
        task.agents,
        task.human,
        task.facts,
        task.init,
        Condition((0,)),
        task.actions,
        Condition(),
        task.warnings,
    )
    assert task.with_goal(Condition((0,))).robot_goal == task.robot_goal
