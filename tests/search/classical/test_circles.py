"""Which actions need one epoch: what could be a circle is told from what can't be."""

import pytest

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.classical.circles import circles
from search.packed.cost_vector import own_actions
from search.packed.packed_task import PackedTask
from serendipity import Task
from serendipity.model import Deadline, Options
from serendipity.testing.builders import task as build
from tests.search.small_tasks import packed_of


def _circles(task: Task) -> list[list[str]]:
    packed: PackedTask = packed_of(task)
    operators = [*packed.own, *packed.joint, *packed.others]
    found = circles(packed, operators, Deadline())
    return [sorted(" ".join(task.actions[op.action].key[1]) for op in circle) for circle in found]


def test_however_many_pairs_there_are_without_a_circle() -> None:
    """Whatever the human does spoils whatever the robot may do, and nothing spoils theirs."""
    human = {f"off{i} h": f"p -> !p x{i}" for i in range(150)}
    robot = {f"use{i} r": f"p -> y{i}" for i in range(150)}
    goal = " ".join(f"{letter}{i}" for letter in "xy" for i in range(150))
    assert _circles(build(init="p", goal=goal, actions=human | robot)) == []


def test_a_circle_behind_what_is_none() -> None:
    actions = {"a h": "p q -> !p x", "b r": "p q -> !q y", "c r": "p -> z", "d h": "z x y -> g"}
    assert _circles(build(init="p q", goal="g", actions=actions)) == [["h", "r"]]


def test_a_circle_counts_all_its_actions() -> None:
    """Of plans that cost nothing the one of two actions, not the circle of three."""
    circle = {"a h": "x -> ga !y", "b r": "y -> gb !z", "c q": "z -> gc !x"}
    more = {"d h": "-> ga gb", "e r": "-> gc"}
    task = build(
        agents="h r q",
        human="h",
        init="x y z",
        goal="ga gb gc",
        actions={name: f"{text} @ 0" for name, text in (circle | more).items()},
    )
    context = SearchContext(PreparedTask(task), Options(mode="composite", horizon="inf"), Deadline())
    if context.team is None:
        pytest.skip("the team's plans need the kernel")
    assert own_actions(context.team.planner.cheapest(context.packed.init, Deadline())) == 2
