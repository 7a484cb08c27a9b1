"""What can be done for a task before anybody asks for a plan."""

from math import prod

from search.heuristics.achievers import shared_fields
from search.human.pattern_database import own_projection, private_fields
from search.packed.packed_task import PackedTask, pack
from search.robots.transition_graphs import TransitionGraphs
from serendipity.model.deadline import Deadline
from serendipity.model.task import Task


def prepare(task: Task, *, afresh: bool = False, deadline: Deadline | None = None) -> None:
    """Pack a task, and find what every call needs of it and what takes time linear in the files.

    That is what robots' actions do to what they share with the human, and the human's private
    distances, unless his private states may be more than the task has actions.  The first
    planning call finds it otherwise, within its time limit.

    Args:
        task: the task.
        afresh: forget first what earlier calls have left with it.
        deadline: asked for time and memory.

    Raises:
        LimitReachedError: the deadline came first; what is ready by then stays with the task.
    """
    if afresh:
        task.forget_derived()
    deadline = deadline or Deadline()
    packed = pack(task, deadline)
    acts = packed.derived(TransitionGraphs, deadline)
    for field in shared_fields(packed, deadline):
        acts.on(field)
    if _most_states(packed) <= len(task.actions):
        packed.derived(own_projection, deadline)


def _most_states(packed: PackedTask) -> int:
    """At least the number of the human's private states."""
    return prod(len(packed.values(field)) for field in private_fields(packed))
