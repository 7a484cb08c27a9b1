"""Actions as one step each, however long they take, and tasks of somebody who acts alone, beside no script.

Nothing happens while an action of theirs goes on, so what its epochs ask for and change is put together.
"""

from dataclasses import replace

from serendipity.model.task.actions import GroundAction
from serendipity.model.task.task import Task


def whole_actions(task: Task) -> Task | None:
    """The task in which each action takes one epoch, with the same ids.

    Returns:
        None where that says nothing of the human's optimal plans: beside a script, or where a cheaper plan
        may be longer, or one of as many epochs have fewer actions.
    """
    own = [task.actions[i] for i in task.human_actions]
    alike = {action.duration for action in own}
    rates = {action.cost / action.duration for action in own}
    if task.script or (len(alike) > 1 and (len(rates) > 1 or 0 in rates)):
        return None
    return in_whole_actions(task)


def in_whole_actions(task: Task) -> Task:
    """The same for a task without a script, where only costs matter."""
    return replace(task, actions=tuple(map(whole, task.actions)))


def whole(action: GroundAction) -> GroundAction:
    """An action as a step of its own; one that no state allows where its start is in its own way."""
    timing = action.timing
    if timing is None:
        return action
    asked = [timing.over_all, timing.at_end]
    true = {fact for condition in asked for fact in condition.positive}
    false = {fact for condition in asked for fact in condition.negative}
    undone = true.intersection(timing.start_delete) | false.intersection(timing.start_add)
    needs = {*action.pre, *true.difference(timing.start_add), *undone}
    never = {*action.neg, *false.difference(timing.start_delete), *undone}
    add = {*action.add, *set(timing.start_add).difference(action.delete)}
    gone = {*action.delete, *timing.start_delete}.difference(add)
    return replace(
        action,
        pre=tuple(sorted(needs)),
        neg=tuple(sorted(never)),
        add=tuple(sorted(add)),
        delete=tuple(sorted(gone)),
        timing=None,
    )
