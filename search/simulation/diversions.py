"""Joint actions that contribute to no goal, and still change what a human who replans does (semantics 6)."""

from search.packed.packed_task import PackedTask, pack
from serendipity.model.deadline import Deadline
from serendipity.model.task import Task


def diversions(task: Task, deadline: Deadline) -> tuple[int, ...]:
    """What the human takes part in because it costs nothing, and is busy with; kept with the task."""
    return task.derived(_find, deadline)


def with_diversions(task: Task, deadline: Deadline) -> PackedTask:
    """The task packed with them; kept with it."""
    return task.derived(_packed, deadline) if diversions(task, deadline) else pack(task, deadline)


def _find(task: Task, deadline: Deadline) -> tuple[int, ...]:
    packed, found = pack(task, deadline), list[int]()
    for i, action in enumerate(task.actions):
        deadline.tick()
        if action.joint and not action.cost and task.human in action.participants and not packed.is_useful(i):
            found.append(i)
    return tuple(found)


def _packed(task: Task, deadline: Deadline) -> PackedTask:
    return PackedTask(task, frozenset(), deadline, diversions(task, deadline))
