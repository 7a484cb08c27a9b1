"""Epochs for a plan that was found without a horizon: as early as the rules allow."""

from collections.abc import Sequence

from serendipity.model.task.actions import apply, conflicting
from serendipity.model.task.plans import Step
from serendipity.model.task.task import Task


def schedule(task: Task, sets: Sequence[tuple[int, ...]]) -> tuple[Step, ...]:
    """Steps with epochs for a sequence of action sets.

    A set joins the epoch before it if it is applicable there already and disturbs
    nothing in it, so the states that follow stay the same.
    """
    epochs: list[list[int]] = []
    before = state = task.init
    for chosen in sets:
        actions = [task.actions[i] for i in chosen]
        joins = bool(epochs) and all(
            action.applicable(before)
            and not any(conflicting(action, task.actions[i], strict=True) for i in epochs[-1])
            for action in actions
        )
        if joins:
            epochs[-1].extend(chosen)
        else:
            epochs.append(list(chosen))
            before = state
        state = apply(state, *actions)
    return tuple(sorted(Step(t, i) for t, ids in enumerate(epochs, start=1) for i in ids))
