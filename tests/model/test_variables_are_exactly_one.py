"""Exactly-one groups hold along every walk, and each fact is in one variable."""

import random

from hypothesis import given
from hypothesis import strategies as st

from serendipity import Task
from serendipity.model import Condition, GroundAction
from serendipity.model.task.variables import find_variables
from serendipity.testing.builders import task as build
from serendipity.testing.strategies import tasks

ACTIONS = st.builds(
    lambda pre, neg, add, delete: GroundAction(
        "a",
        (0,),
        tuple(sorted(pre)),
        tuple(sorted(neg - pre)),
        tuple(sorted(add)),
        tuple(sorted(delete - add)),
    ),
    *[st.frozensets(st.integers(0, 7), max_size=3)] * 4,
)


def keeps_exactly_one(group: frozenset[int], action: GroundAction) -> bool:
    """Whether ``action``, applied where exactly one of ``group`` is true, keeps it so."""
    needed = group.intersection(action.pre)
    added = group.intersection(action.add)
    deleted = group.intersection(action.delete)
    if len(needed) > 1 or not (added or deleted):
        return True  # never applicable, or does not touch the group
    if len(added) > 1:
        return False
    if not added:
        return bool(needed) and not needed & deleted
    if needed:
        return needed <= deleted or needed == added
    return group - added <= deleted


def walk(task: Task, steps: int, seed: int) -> list[frozenset[int]]:
    rng = random.Random(seed)
    states = [task.init]
    for _ in range(steps):
        applicable = [a for a in task.actions if a.applicable(states[-1])]
        if not applicable:
            break
        action = rng.choice(applicable)
        states.append(states[-1].difference(action.delete).union(action.add))
    return states


def check(task: Task, seed: int) -> None:
    members = [fact for variable in task.variables for fact in variable.facts]
    assert sorted(members) == list(range(len(task.facts)))
    for state in walk(task, 40, seed):
        for variable in task.variables:
            if not variable.boolean:
                assert sum(fact in state for fact in variable.facts) == 1


@given(tasks(), st.integers(0, 1000))
def test_groups_hold_along_walks(task: Task, seed: int) -> None:
    check(task, seed)


@given(st.frozensets(st.integers(0, 7), max_size=4), st.lists(ACTIONS, max_size=8), st.integers(0, 1000))
def test_groups_hold_whatever_the_actions(
    init: frozenset[int], actions: list[GroundAction], seed: int
) -> None:
    names = tuple(f"f{i}" for i in range(8))
    task = Task("random", ("h",), 0, names, init, Condition(), tuple(actions))
    check(task, seed)
    for variable in find_variables(names, init, actions):
        if not variable.boolean:
            assert all(keeps_exactly_one(frozenset(variable.facts), action) for action in actions)


def test_a_position_and_a_carried_thing_are_found() -> None:
    task = build(
        init="at-a kit-a",
        actions={
            "go h": "at-a -> at-b !at-a",
            "back h": "at-b -> at-a !at-b",
            "take-a h": "at-a kit-a -> held busy !kit-a",
            "drop-b h": "at-b held -> kit-b seen-b !held !busy",
            "drop-a h": "at-a held -> kit-a !held !busy",
            "take-b h": "at-b kit-b -> held busy !kit-b",
        },
    )
    groups = {
        frozenset(task.facts[f] for f in variable.facts)
        for variable in task.variables
        if not variable.boolean
    }
    assert groups == {frozenset({"at-a", "at-b"}), frozenset({"kit-a", "kit-b", "held"})} or groups == {
        frozenset({"at-a", "at-b"}),
        frozenset({"kit-a", "kit-b", "busy"}),
    }


def test_what_two_groups_move_together_stays_in_the_later_one() -> None:
    """``b1`` is unbalanced for the group of ``a0``, but not for that of ``b0``, which comes later."""
    task = build(
        init="a0 b0",
        actions={
            "both h": "a0 b0 -> a1 b1 !a0 !b0",
            "back h": "a1 -> a0 !a1",
            "on h": "b0 -> b2 !b0",
            "up h": "b2 -> b1 !b2",
        },
    )
    groups = [[task.facts[f] for f in variable.facts] for variable in task.variables]
    assert groups == [["a0", "a1"], ["b0", "b1", "b2"]]


def test_a_trace_that_all_groups_leave_is_a_boolean() -> None:
    moves = {f"move-{x} h": f"{x}0 -> {x}1 trace !{x}0" for x in "abc"}
    moves |= {f"back-{x} h": f"{x}1 -> {x}0 !{x}1 !trace" for x in "abc"}
    task = build(init="a0 b0 c0", actions=moves)
    groups = [[task.facts[f] for f in variable.facts] for variable in task.variables]
    assert groups == [["a0", "a1"], ["b0", "b1"], ["c0", "c1"], ["trace"]]


def test_a_thing_that_can_vanish_has_no_group() -> None:
    task = build(init="a0", actions={"go h": "a0 -> a1 !a0", "back h": "a1 -> a0 !a1", "lose h": "a1 -> !a1"})
    assert all(variable.boolean for variable in task.variables)


def test_a_door_that_opens_for_good_is_a_boolean() -> None:
    task = build(init="shut", actions={"open h": "shut -> !shut"})
    assert all(variable.boolean for variable in task.variables)
