"""The human's key from a state, asked within limits: what is not below a limit is not out of reach."""

import pytest

from search import PreparedTask
from search.call.context import SearchContext
from search.classical.planner import ClassicalPlanner
from search.kernel.library import library
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model import Options, Task
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.builders import task as build
from serendipity.testing.countdown import Countdown


def _door() -> Task:
    """From b on the human needs ``p``, which only a robot changes: the private bound takes it for granted."""
    actions = {"in h": "a -> b !a", "out h": "b p -> g !b", "around h": "b -> g !b @ 5", "open r": "-> p @ 9"}
    return build(init="a", goal="g", actions=actions)


def test_what_is_beyond_a_limit_is_found_under_a_higher_one() -> None:
    task = _door()
    context = SearchContext(PreparedTask(task), Options(), Deadline())
    alone, keys = context.alone, context.keys
    packed = context.packed
    start = packed.init
    op = next(op for op in packed.own if task.actions[op.action].name == "in h")
    inside = start & op.keep | op.put
    assert keys.cost(alone.key(inside)) == 5
    low = keys.of_cost(task.actions[op.action].cost * 4)
    assert alone.key(start, low) >= low
    assert alone.key(start) < INFINITE_KEY
    assert keys.cost(alone.key(start)) == 6


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
def test_all_plans_are_looked_for_with_a_look_at_the_clock_before_each_bound(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A bound of the kernel may take a millisecond, and a state has a hundred successors."""
    deadline, bound = Countdown(10**9), ClassicalPlanner.bound
    looks: list[int] = []

    def watched(self: ClassicalPlanner, state: int, given: Deadline) -> int:
        looks.append(deadline.left_over[0])
        return bound(self, state, given)

    errands = {
        f"{step}{k} h": f"{before} -> {step}{k}"
        for k in range(4)
        for before, step in (("", "a"), (f"a{k}", "b"))
    }
    helped = {f"b{k} r": f"a{k} -> b{k}" for k in range(4)}
    task = build(goal="b0 b1 b2 b3", actions={**errands, **helped})
    context = SearchContext(PreparedTask(task), Options(), deadline)
    assert context.alone.key(context.packed.init) < INFINITE_KEY
    monkeypatch.setattr(ClassicalPlanner, "bound", watched)
    plans = context.optimal_plans()
    assert plans is not None and len(looks) > 50
    assert len(set(looks)) >= len(looks) - 1
