"""What happens in a task in single epochs, whether anybody chooses it or not."""

from collections.abc import Iterable, Iterator

from serendipity.model.task.actions import GroundAction, apply
from serendipity.model.task.plans import Step
from serendipity.model.task.task import Task
from serendipity.model.task.unit_steps import CLOCK


def due(task: Task, state: frozenset[int]) -> list[GroundAction]:
    """What goes on in a state whatever is chosen: of each action the variant that can, or the first."""
    found = []
    for fact in sorted(state.intersection(task.due_for)):
        for variants in task.due_for[fact]:
            actions = [task.actions[i] for i in variants]
            found.append(next((one for one in actions if one.applicable(state)), actions[0]))
    return found


def after(task: Task, state: frozenset[int], actions: Iterable[GroundAction]) -> frozenset[int]:
    """The state after an epoch; the script comes last."""
    clock = task.agents.index(CLOCK) if CLOCK in task.agents else -1
    each = list(actions)
    state = apply(state, *(one for one in each if clock not in one.participants))
    return apply(state, *(one for one in each if clock in one.participants))


def epochs(
    task: Task, steps: Iterable[Step], last: int
) -> Iterator[tuple[frozenset[int], list[GroundAction]]]:
    """Epochs up to one, as far as anything happens in them: the state before, and what does."""
    begun: dict[int, list[GroundAction]] = {}
    for step in steps:
        begun.setdefault(step.epoch, []).append(task.actions[step.action])
    state = task.init
    for epoch in range(1, last + 1) if task.due else sorted(begun):
        actions = {id(one): one for one in (*begun.get(epoch, ()), *due(task, state))}
        yield state, list(actions.values())
        state = after(task, state, actions.values())
