"""What really happens: the states of a result's plan, and of the human's former plan."""

from collections import defaultdict
from dataclasses import dataclass

from serendipity.model import GroundAction, InputError, PlanStep, Result, Task
from serendipity.model.task.actions import State, apply
from serendipity.model.task.execution import actions_named


@dataclass(frozen=True, slots=True)
class Moment:
    """An epoch and the state after it; the first moment is the initial state, epoch 0."""

    epoch: int
    actions: tuple[GroundAction, ...]
    state: frozenset[int]


def replay(task: Task, result: Result) -> tuple[Moment, ...]:
    """The moments of a result's plan; without one, of the human's own plan.

    Raises:
        InputError: the plan names an action that the task lacks or that is not applicable.
    """
    if result.plan is None:
        return replay_former(task, result)
    by_epoch: dict[int, list[PlanStep]] = defaultdict(list)
    for step in result.plan:
        by_epoch[step.epoch].append(step)
    moments = [Moment(0, (), task.init)]
    turns = result.mode == "assistance"  # they act one after the other (semantics 7)
    for epoch in range(1, max(by_epoch, default=0) + 1):
        state = before = moments[-1].state
        actions = []
        for step in by_epoch[epoch]:
            action = _find(task, step, state if turns else before)
            actions.append(action)
            state = apply(state, action)
        moments.append(Moment(epoch, tuple(actions), state))
    return tuple(moments)


def replay_former(task: Task, result: Result) -> tuple[Moment, ...]:
    """The moments of the human's former plan with idle robots; the initial one without a plan.

    Raises:
        InputError: the plan can't be executed in the task.
    """
    plan = task.plan_from_names(result.human_plan or ()) if result.human_plan else ()
    moments = [Moment(0, (), task.init)]
    for epoch, i in enumerate(plan, start=1):
        action = task.actions[i]
        moments.append(Moment(epoch, (action,), apply(moments[-1].state, action)))
    return tuple(moments)


def _find(task: Task, step: PlanStep, state: State) -> GroundAction:
    """The action of a step; of several with one name, the first that is applicable."""
    agents = {name.lower() for name in step.agents}
    same = [task.actions[i] for i in actions_named(task, step.action.lower(), agents)]
    if not same:
        who = ", ".join(step.agents)
        raise InputError(f"plan, epoch {step.epoch}: the task has no action '{step.action}' of {who}")
    for action in same:
        if action.applicable(state):
            return action
    raise InputError(f"plan, epoch {step.epoch}: '{step.action}' is not applicable in this task")
