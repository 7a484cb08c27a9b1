"""Plans where something happens without being chosen: parts of actions that go on, the script (semantics 10).

All this is about tasks in single epochs (:mod:`serendipity.model.task.unit_steps`).
"""

from collections.abc import Iterable, Sequence

from serendipity.model import HumanPlan, Step, Task
from serendipity.model.task.unit_steps import RESTING, WAITING
from verify.base.execution import State, by_epoch, executed, idling, is_calm, met


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


def going_on(task: Task, epochs: int, *, strict: bool) -> HumanPlan:
    """What the human is at in the beginning, epoch by epoch, for some epochs at most."""
    state: State | None = task.init
    found: HumanPlan = ()
    while state is not None and len(found) < epochs:
        his = [i for i in met(task, state, ()) if task.human in task.actions[i].participants]
        if not his:
            break
        found, state = (*found, his[0]), onward(task, state, (), strict=strict)
    return found


def after_waiting(task: Task, plan: HumanPlan, epochs: int, *, strict: bool) -> HumanPlan:
    """A human plan from some epochs on, with waiting before it, once they are free.

    Who does nothing then has not waited for that.
    """
    acts, busy = not idling(task).issuperset(plan), going_on(task, epochs, strict=strict)
    waiting = (not acts and task.named.get(RESTING)) or task.named.get(WAITING, ())
    return busy + waiting[:1] * (epochs - len(busy)) + plan


def turns(task: Task, plan: Sequence[int], xi1: int) -> list[int]:
    """The epochs of a human plan whose state a window from ``xi1`` on may preserve (semantics 3.3).

    With them ``pi_H[1..j]`` is over, for each j; what is begun before ``xi1`` is part of that.
    """
    going_on, waiting = {i for _, i in task.due}, idling(task)
    acted = [0, *(k for k, i in enumerate(plan, start=1) if i not in waiting)]
    begun = max(k for k in acted if k < xi1)
    return [k for k in acted if k >= begun and (k in (0, len(plan)) or plan[k] not in going_on)]


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
