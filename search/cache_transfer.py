"""Replanning calls: what was packed for a task serves it in another state."""

from search.human.pattern_database import human_graph
from search.packed.packed_task import pack_plainly
from serendipity.model.task import Task


def at_state(task: Task, state: frozenset[int]) -> Task:
    """The task from another state, with as much of what is packed for it as still holds.

    Args:
        task: a task that calls may have been asked of.
        state: ids of the facts that are true now.
    """
    moved = task.at(state)
    packed = task.kept(pack_plainly)
    if packed is not None and moved.variables is task.variables:
        graph = packed.kept(human_graph)
        # What can be reached from a state that was reached has been reached.
        known = graph is not None and packed.pack(state) & graph.mask in graph.moves
        moved.keep_derived(pack_plainly, packed.moved_to(moved, derived=known))
    return moved
