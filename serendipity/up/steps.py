"""Steps of a plan as actions of a task."""

from serendipity.model import GroundAction, PlanError, PlanStep, Task
from serendipity.model.task.actions import State


def variant_in(task: Task, step: PlanStep, state: State) -> GroundAction:
    """The action that a step means in a state.

    Raises:
        PlanError: none is applicable.
    """
    ids = task.named.get(step.action, ())
    for i in ids:
        if task.actions[i].applicable(state):
            return task.actions[i]
    what = "applicable" if ids else "an action of the problem"
    raise PlanError(f"epoch {step.epoch}: '{step.action}' is not {what}")
