"""Plans where something happens without being chosen: parts of actions that go on, the script (semantics 10).

All this is about tasks in single epochs (:mod:`serendipity.model.task.unit_steps`).
"""

from collections.abc import Iterable, Sequence

from serendipity.model import Step, Task
from verify.base.execution import State, by_epoch, executed, is_calm, met


def onward(task: Task, state: State, chosen: Iterable[int], *, strict: bool) -> State | None:
    """The state after an epoch of actions and what is due; None if that is impossible."""
    return executed(state, [task.actions[i] for i in met(task, state, chosen)], strict=strict)


def waited(task: Task, state: State, epochs: int, *, strict: bool, plan: Sequence[int] = ()) -> State | None:
    """The state after some epochs of a plan and what is due; None if that is impossible."""
    here: State | None = state
    for epoch in range(epochs):
        if here is None or (epoch >= len(plan) and is_calm(task, here)):
            break
        here = onward(task, here, plan[epoch : epoch + 1], strict=strict)
    return here


def filled(task: Task, steps: Iterable[Step], last: int, *, strict: bool) -> tuple[Step, ...]:
    """A plan with all that is due; where it can't be executed any more what is left stays as it is."""
    sets = by_epoch(steps)
    state: State | None = task.init
    found: list[Step] = []
    epoch = 0
    while state is not None and epoch != last and (sets or not is_calm(task, state)):
        epoch += 1
        chosen = met(task, state, sets.pop(epoch, ()))
        found += [Step(epoch, i) for i in chosen]
        state = executed(state, [task.actions[i] for i in chosen], strict=strict)
    return (*found, *(Step(epoch, i) for epoch in sorted(sets) for i in sets[epoch]))
