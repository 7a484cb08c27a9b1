"""Random tasks mean one thing: a name stands for what all its variants do in the state at hand."""

from dataclasses import replace
from itertools import combinations

import pytest

from serendipity.model import Task
from serendipity_testing.builders import task as build
from serendipity_testing.generator.calls import PlanCall, random_call
from serendipity_testing.generator.tasks import unambiguous
from serendipity_testing.shrinking import shrink


def ambiguous_pairs(task: Task) -> list[str]:
    """Names of variants that do different things although neither forbids what the other asks for."""
    return [
        a.name
        for a, b in combinations(task.actions, 2)
        if a.name == b.name
        and (a.add, a.delete) != (b.add, b.delete)
        and not set(a.pre) & set(b.neg)
        and not set(b.pre) & set(a.neg)
    ]


@pytest.mark.parametrize("first", range(264132700, 264132900, 20))
def test_random_tasks(first: int) -> None:
    """Among them is one in which a name meant two things, and plans with it were refuted."""
    for seed in range(first, first + 20):
        assert ambiguous_pairs(random_call(seed).task) == []


def test_shrinking_keeps_variants_apart() -> None:
    task = build(goal="g", actions={"do r": "a -> b | !a -> b g", "go h": "b -> g"})
    assert unambiguous(task)
    smaller = shrink(PlanCall(task), lambda call: len(call.task.actions) == 3)
    assert ambiguous_pairs(smaller.task) == []
    apart = [replace(action, pre=(), neg=()) for action in task.actions]
    assert not unambiguous(replace(task, actions=tuple(apart)))
