"""A text where a list is meant, or a name where a task is, gets one sentence and no error of Python's."""

from collections.abc import Callable
from typing import Any

import pytest

import serendipity
from serendipity import Session, Task, UsageError

WRONG: dict[str, tuple[Callable[[Task], Any], str]] = {
    "no task": (lambda _: serendipity.plan(None), "task: expected a Task"),  # type: ignore[arg-type]
    "a task's name": (lambda _: serendipity.plan("room2"), "task: expected a Task.* got 'room2'"),  # type: ignore[arg-type]
    "a session of a name": (lambda _: Session("room2"), "task: expected a Task"),  # type: ignore[arg-type]
    "a plan as a text": (
        lambda task: serendipity.plan(task, human_plan="move commx room13 hall8"),
        "human plan: expected a list of names, got 'move commx",
    ),
    "a plan of numbers": (
        lambda task: serendipity.plan(task, human_plan=[1, 2]),  # type: ignore[list-item]
        r"human plan: expected a list of names, got \[1, 2\]",
    ),
    "an action as a text": (
        lambda task: Session(task).execute("move commx room13 hall8"),
        "actions: expected a list of names",
    ),
    "what the human follows": (
        lambda task: Session(task).follow("move"),
        "human plan: expected a list of names",
    ),
    "a goal as a text": (
        lambda task: Session(task).set_goal("at commx hall8"),
        "goal: expected a list of names",
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_wrong_types(what: str) -> None:
    ask, message = WRONG[what]
    with pytest.raises(UsageError, match=message):
        ask(serendipity.example("room2"))
