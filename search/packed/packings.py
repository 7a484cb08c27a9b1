"""The ways in which a task is packed: which facts and actions beyond those that matter to the goals."""

from collections.abc import Iterable
from dataclasses import replace

from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task
from serendipity.model.task.unit_steps import CLOCK
from serendipity.model.task.variables import Variable


def human_facts(task: Task) -> frozenset[int]:
    """Ids of the facts that the human's own domain mentions (semantics 3.3)."""
    mentioned = {*task.goal.positive, *task.goal.negative}
    for i in task.human_actions:
        action = task.actions[i]
        mentioned.update(action.pre, action.neg, action.add, action.delete)
    return frozenset(mentioned)


def asked_facts(task: Task, actions: Iterable[int]) -> frozenset[int]:
    """Ids of the facts that actions ask for."""
    return frozenset(f for i in actions for f in (*task.actions[i].pre, *task.actions[i].neg))


def diversions(packed: PackedTask, deadline: Deadline) -> tuple[int, ...]:
    """Joint actions that contribute to no goal, and still change what a human who replans does.

    That is what they take part in because it costs nothing, and is busy with (semantics 6).
    """
    task = packed.task
    return tuple(
        i
        for i, action in deadline.each(enumerate(task.actions))
        if action.joint and not action.cost and task.human in action.participants and not packed.is_useful(i)
    )


def doubted(task: Task, deadline: Deadline) -> Task:
    """The task for a human who may be wrong about everything that others change.

    A belief of theirs may hold two values of one variable, or none: they saw that the kit has
    left the room, but not where it went.  So for them only the variables that nobody
    else changes stay variables, of which they always know the truth, as they do of the clock;
    every other fact is a bit by itself.
    """
    shared, clock = set[int](), task.agents.index(CLOCK) if CLOCK in task.agents else None
    ticks = {fact for fact, action in task.due if task.actions[action].participants == (clock,)}
    for action in deadline.each(task.actions):
        if task.human not in action.participants:
            shared.update(action.add, action.delete)
    found: list[Variable] = []
    for variable in deadline.each(task.variables):
        if shared.isdisjoint(variable.facts) or not ticks.isdisjoint(variable.facts):
            found.append(variable)
        else:
            found += [Variable((fact,)) for fact in variable.facts]
    return replace(task, known_variables=tuple(sorted(found, key=lambda variable: variable.facts)))
