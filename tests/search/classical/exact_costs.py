"""What the human pays alone from each state, found without any of the search's algorithms."""

from search.packed.cost_vector import INFINITE_KEY, own_weights
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from tests.search.small_tasks import reached
from tests.shortest import distances


def exact(packed: PackedTask) -> dict[int, int]:
    """The least weight to the goal from each state that the human can reach alone."""
    weights = own_weights(packed)
    into: dict[int, list[tuple[int, int]]] = {state: [] for state in reached(packed, packed.own)}
    for state in into:
        for op in packed.own:
            if applicable(op, state):
                into[state & op.keep | op.put].append((weights[op.cost], state))
    return dict.fromkeys(into, INFINITE_KEY) | distances(filter(packed.goal.holds, into), into)
