"""What really happens: the states of a result's plan, and of the human's former plan."""

from collections import defaultdict
from dataclasses import dataclass

from serendipity.model import GroundAction, InputError, PlanStep, Result, Task
from serendipity.model.task.actions import State, apply
from serendipity.model.task.execution import actions_named, variant_named


@dataclass(frozen=True, slots=True)
class Snapshot:
    """An epoch and the state after it; the first is the initial state, epoch 0."""

    epoch: int
    actions: tuple[GroundAction, ...]
    state: frozenset[int]


def replay(task: Task, result: Result) -> tuple[Snapshot, ...]:
    """The epochs of a result's plan; without one, of the human's own plan.

    Raises:
        InputError: the plan names an action that the task lacks or that is not applicable.
    """
    if result.plan is None:
        return replay_former(task, result)
    by_epoch: dict[int, list[PlanStep]] = defaultdict(list)
    for step in result.plan:
        by_epoch[step.epoch].append(step)
    found = [Snapshot(0, (), task.init)]
    turns = result.mode == "assistance"  # they act one after the other (semantics 7)
    for epoch in range(1, max(by_epoch, default=0) + 1):
        state = before = found[-1].state
        actions = []
        for step in by_epoch[epoch]:
            actions.append(_find(task, step, state if turns else before))
            state = apply(state, actions[-1])
        found.append(Snapshot(epoch, tuple(actions), state))
    return tuple(found)


def replay_former(task: Task, result: Result) -> tuple[Snapshot, ...]:
    """The epochs of the human's former plan with idle robots; the initial one without a plan.

    Raises:
        InputError: the plan can't be executed in the task.
    """
    if not result.human_plan:
        return (Snapshot(0, (), task.init),)
    plan = task.plan_from_names(result.human_plan)
    did = [(), *((task.actions[i],) for i in plan)]
    return tuple(map(Snapshot, range(len(did)), did, task.replay_alone(plan)))


def _find(task: Task, step: PlanStep, state: State) -> GroundAction:
    """The action of a step; of several with one name, the first that is applicable."""
    name, agents = step.action.lower(), [agent.lower() for agent in step.agents]
    where = f"plan, epoch {step.epoch}:"
    if not actions_named(task, name, agents):
        raise InputError(f"{where} the task has no action '{step.action}' of {', '.join(step.agents)}")
    action = task.actions[variant_named(task, name, agents, state)]
    if not action.applicable(state):
        raise InputError(f"{where} '{step.action}' is not applicable in this task")
    return action
