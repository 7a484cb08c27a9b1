"""What the human pays alone from each state, found without any of the search's algorithms."""

from collections import deque

from search import PreparedTask
from search.packed.cost_vector import INFINITE_KEY, own_weights
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from serendipity import Task
from serendipity.model.resources.deadline import Deadline


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
