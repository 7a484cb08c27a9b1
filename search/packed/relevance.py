"""Relevance: facts and actions that can matter to the goals; all else is not packed."""

from collections.abc import Collection
from itertools import compress

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.script import UNDER_WAY
from serendipity.model.task.task import Task
from serendipity.model.task.unit_steps import CLOCK


def deeds_of(task: Task) -> list[int]:
    """What bystanders do, and others are in the middle of, which has to stay possible (semantics "Time")."""
    people = {agent for agent in task.script.people if task.agents[agent] != CLOCK}
    due = ((i, task.actions[i]) for _, i in task.due)
    return [i for i, a in due if not people.isdisjoint(a.participants) or a.name.startswith(UNDER_WAY)]


def relevant_to_goals(
    task: Task, extra: frozenset[int], deadline: Deadline, kept: Collection[int] = ()
) -> tuple[set[int], tuple[int, ...]]:
    """Facts and actions from which the goals can be influenced (backward closure).

    Args:
        extra: facts that matter, too.
        kept: actions that matter, whatever they do.
    """
    actions = task.actions
    relevant = {*extra, *task.goal.positive, *task.goal.negative}
    relevant.update(task.robot_goal.positive, task.robot_goal.negative)
    useful = bytearray(len(actions))
    for i in kept:
        relevant.update(actions[i].pre, actions[i].neg)
        useful[i] = 1
    changers: list[list[int]] = [[] for _ in task.facts]
    for i, action in deadline.each(enumerate(actions)):
        for fact in action.add + action.delete:
            changers[fact].append(i)
    pending = list(relevant)
    while pending:
        for i in changers[pending.pop()]:
            if useful[i]:
                continue
            deadline.tick()
            useful[i] = 1
            cause = actions[i]
            for fact in cause.pre + cause.neg:
                if fact not in relevant:
                    relevant.add(fact)
                    pending.append(fact)
    return relevant, tuple(compress(range(len(actions)), useful))
