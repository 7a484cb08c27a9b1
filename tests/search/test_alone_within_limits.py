"""The human's key from a state, asked within limits: what is not below a limit is not out of reach."""

from search import PreparedTask
from search.call.context import SearchContext
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model import Options, Task
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.builders import task as build


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
