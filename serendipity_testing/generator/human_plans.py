"""Random plans of the human that are given: optimal ones and others."""

from dataclasses import replace
from random import Random

from serendipity.model import HumanPlan, PlanError, Task
from serendipity.model.task.actions import apply
from verify.base.optimal_plans import OptimalPlans

_LONGEST = 6
"""Actions of a human plan that is given."""


def random_human_plan(dice: Random, task: Task) -> HumanPlan | None:
    """A plan of the human at random, their best or not; None if none was found."""
    for _ in range(12):
        state, plan = task.init, list[int]()
        while len(plan) < _LONGEST and not (task.goal.holds(state) and dice.random() < 0.8):
            ways = [i for i in task.human_actions if task.actions[i].applicable(state)]
            if not ways:
                break
            plan.append(dice.choice(ways))
            action = task.actions[plan[-1]]
            state = apply(state, action)
        if task.goal.holds(state):
            return tuple(plan)
    return None


def plan_after_detour(dice: Random, task: Task) -> HumanPlan | None:
    """Up to three actions at random, and what is best from there on; None if nothing is."""
    state, plan = task.init, list[int]()
    for _ in range(dice.choice((0, 1, 1, 2, 3))):
        ways = [i for i in task.human_actions if task.actions[i].applicable(state)]
        if ways:
            plan.append(dice.choice(ways))
            state = apply(state, task.actions[plan[-1]])
    rest = OptimalPlans(replace(task, init=state)).canonical()
    return None if rest is None else (*plan, *rest)


def with_times(
    task: Task, plan: HumanPlan, gap: int, *, strict: bool = False
) -> tuple[tuple[int, str], ...] | None:
    """A plan with its times, so many epochs later; None: it comes too late, or is in a bystander's way."""
    starts = (start + gap for start in task.starts_of(plan))
    given = tuple(zip(starts, (task.actions[i].name for i in plan), strict=True))
    try:
        task.replay_alone(task.plan_from_names(given), strict=strict)
    except PlanError:
        return None
    return given
