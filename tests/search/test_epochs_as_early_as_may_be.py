"""A plan that was found without a horizon gets epochs: it stays a plan, to the same state, and takes few."""

from search.packed.parallelise import schedule
from serendipity import Task
from serendipity_testing.builders import task as build


def epochs_of(task: Task, order: list[int]) -> list[list[int]]:
    steps = schedule(task, [(i,) for i in order])
    last = max((step.epoch for step in steps), default=0)
    return [[step.action for step in steps if step.epoch == epoch] for epoch in range(1, last + 1)]


def test_what_one_does_after_the_other_is_done_beside_it() -> None:
    """Each step of the second robot joined the last epoch of the first, and no other."""
    steps = {f"{a}{i} {a}": f"{a}{i} -> !{a}{i} {a}{i + 1}" for a in "hr" for i in range(4)}
    task = build(init="h0 r0", goal="h4 r4", actions=steps)
    numbers = {action.name: i for i, action in enumerate(task.actions)}
    order = [numbers[name] for name in sorted(numbers)]
    assert len(epochs_of(task, order)) == 4


def test_what_waits_for_another_comes_after_it() -> None:
    task = build(init="p", goal="z", actions={"a h": "p -> x", "b r": "x -> y", "c h": "y -> z"})
    numbers = {action.name.split()[0]: i for i, action in enumerate(task.actions)}
    assert epochs_of(task, [numbers[name] for name in "abc"]) == [[numbers[name]] for name in "abc"]
