"""What can matter to the goals, whatever anybody does: all else is not packed."""

from search.clock import Clock
from serendipity.model.actions import GroundAction
from serendipity.model.task import Task


def relevant_to_goals(task: Task, extra: frozenset[int], clock: Clock) -> tuple[set[int], tuple[int, ...]]:
    """Facts and actions from which the goals can be influenced (backward closure)."""
    relevant = {*extra, *task.goal.positive, *task.goal.negative}
    relevant.update(task.robot_goal.positive, task.robot_goal.negative)
    changers: dict[int, list[int]] = {}
    for i, action in enumerate(task.actions):
        clock.tick()
        for fact in action.add + action.delete:
            changers.setdefault(fact, []).append(i)
    useful: set[int] = set()
    pending = list(relevant)
    while pending:
        for i in changers.get(pending.pop(), ()):
            if i in useful:
                continue
            clock.tick()
            useful.add(i)
            cause: GroundAction = task.actions[i]
            for fact in (*cause.pre, *cause.neg):
                if fact not in relevant:
                    relevant.add(fact)
                    pending.append(fact)
    return relevant, tuple(sorted(useful))
