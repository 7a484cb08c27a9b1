"""Bounds from patterns never exceed what the human pays alone, and are consistent."""

from collections import deque

import pytest
from hypothesis import given

from search import PreparedTask
from search.abstractions.bound import own_bound
from search.abstractions.reachability import may_reach
from search.human import individual_planner
from search.packed.cost_vector import INFINITE_KEY, own_weights
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from search.packed.successor_generator import Lookup
from serendipity import Task, plan
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.builders import task as build
from serendipity.testing.strategies import family_tasks, tasks


def packed_of(task: Task) -> PackedTask:
    return PreparedTask(task).plain(Deadline()).packed


def exact(packed: PackedTask) -> dict[int, int]:
    """The least weight to the goal from each state that the human can reach alone."""
    weights = own_weights(packed)
    pending, into = deque([packed.init]), dict[int, list[tuple[int, int]]]({packed.init: []})
    while pending:
        state = pending.popleft()
        for op in packed.own:
            if applicable(op, state):
                after = state & op.keep | op.put
                if after not in into:
                    into[after] = []
                    pending.append(after)
                into[after].append((state, weights[op.cost]))
    found = {state: 0 if packed.goal.holds(state) else INFINITE_KEY for state in into}
    changed = True
    while changed:
        changed = False
        for after, edges in into.items():
            for state, weight in edges:
                if found[after] + weight < found[state]:
                    found[state], changed = found[after] + weight, True
    return found


@given(tasks() | family_tasks())
def test_bounds_never_exceed_and_are_consistent(task: Task) -> None:
    packed = packed_of(task)
    weights, costs = own_weights(packed), exact(packed)
    lookup = Lookup(packed.own_index, lambda op: weights[op.cost])
    bound = own_bound(packed, packed.goal, lambda op: weights[op.cost], lookup, packed.init, Deadline())
    if bound is None:
        return
    for state, cost in costs.items():
        assert bound(state) <= cost
        for op in packed.own:
            if applicable(op, state):
                assert bound(state) <= weights[op.cost] + bound(state & op.keep | op.put)


@given(tasks() | family_tasks())
def test_what_the_relaxation_can_not_reach_is_out_of_reach(task: Task) -> None:
    packed = packed_of(task)
    for state, cost in exact(packed).items():
        if not may_reach(state, packed.goal, packed.fields, packed.own, Deadline()):
            assert cost >= INFINITE_KEY


@given(tasks() | family_tasks())
def test_refining_at_once_changes_no_answer(task: Task) -> None:
    expected = plan(task, mode="individual")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(individual_planner, "_MANY", 1)
        refined = plan(Task(**{name: getattr(task, name) for name in FIELDS}), mode="individual")
    assert refined.human_plan == expected.human_plan
    assert (refined.status, refined.cost) == (expected.status, expected.cost)


FIELDS = ("name", "agents", "human", "facts", "init", "goal", "actions", "robot_goal", "disjunctions")


def test_a_tower_is_bounded_better_than_by_counting() -> None:
    """Three blocks to turn over: each goal alone costs one or two steps, together they cost six."""
    blocks = "abc"
    actions = {}
    for x in blocks:
        here = f"clear-{x} table-{x} free"
        actions[f"pick-{x} h"] = f"{here} -> held-{x} {_false(here)}"
        actions[f"put-{x} h"] = f"held-{x} -> {here} !held-{x}"
        for y in blocks.replace(x, ""):
            actions[f"stack-{x}{y} h"] = (
                f"held-{x} clear-{y} -> on-{x}{y} clear-{x} free !held-{x} !clear-{y}"
            )
            actions[f"lift-{x}{y} h"] = (
                f"on-{x}{y} clear-{x} free -> held-{x} clear-{y} !on-{x}{y} !clear-{x} !free"
            )
    task = build(init="on-ab on-bc table-c clear-a free", goal="on-cb on-ba", actions=actions)
    packed = packed_of(task)
    weights = own_weights(packed)
    lookup = Lookup(packed.own_index, lambda op: weights[op.cost])
    bound = own_bound(packed, packed.goal, lambda op: weights[op.cost], lookup, packed.init, Deadline())
    assert bound is not None
    assert bound(packed.init) == exact(packed)[packed.init] == 6 * weights[0]


def _false(facts: str) -> str:
    return " ".join(f"!{fact}" for fact in facts.split())
