"""Results built by hand from tasks and plans, without a planner; tests doctor them."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from serendipity.model import Options, PlanStep, Result, Task, Window
from serendipity.model.keywords import Horizon
from serendipity.model.numbers import figure, rounded, total
from serendipity.model.task.execution import participants, shares


def result(
    task: Task,
    plan: Mapping[int, str],
    *,
    human_plan: tuple[str, ...] | None,
    window: tuple[int, int] | None = None,
    horizon: Horizon | None = None,
    **options: Any,
) -> Result:
    """An ``optimal`` result with all its figures worked out from the plan.

    Args:
        plan: names of actions by epoch, several separated by ``;``.
        human_plan: names of ``pi_H``.
        window: ``(start, end)``; a plan with one is an opportunity.
        horizon: ``T`` or ``"inf"`` where it is asked for; None is the length of ``pi_H``.
        options: of the call, but the horizon.
    """
    chosen = Options(horizon=horizon, **options)
    by_name = {action.name: action for action in task.actions}
    done = [(epoch, by_name[name.strip()]) for epoch, names in plan.items() for name in names.split(";")]
    actions = [action for _, action in done]
    cost = total(task.team_cost(action, chosen.discount) for action in actions)
    his = [action for action in actions if task.human in action.participants]
    announced = total(action.cost for action in his if action.name not in (human_plan or ()))
    talk = chosen.communication_weight * announced if chosen.mode == "communication" else 0
    human_cost = None if human_plan is None else total(by_name[name].cost for name in human_plan)
    saving = None if human_cost is None else human_cost - cost
    objective = cost + talk + (0 if window is None else chosen.window_weight * (window[1] - window[0]))
    steps = (
        PlanStep(
            epoch, participants(task, action), action.name, figure(task.team_cost(action, chosen.discount))
        )
        for epoch, action in done
    )
    return Result(
        mode=chosen.mode,
        status="optimal",
        human=task.agents[task.human],
        options=chosen,
        human_plan=human_plan,
        human_cost=rounded(human_cost),
        opportunity=saving is not None and saving > 0,
        cost=figure(cost),
        saving=rounded(saving),
        objective=figure(objective),
        lower_bound=figure(objective),
        horizon=len(human_plan or ()) if horizon is None else horizon,
        window=None if window is None else Window(*window),
        saving_alone=None if human_cost is None else 0.0,
        plan=tuple(steps),
        agent_costs={task.agents[i]: figure(s) for i, s in shares(task, actions, chosen.discount).items()},
    )


def with_steps(given: Result, *changes: tuple[int, PlanStep | None]) -> Result:
    """``given`` with steps replaced by index, or dropped for None."""
    steps: list[PlanStep | None] = list(given.plan or ())
    for index, step in changes:
        steps[index] = step
    return replace(given, plan=tuple(step for step in steps if step is not None))


def step(given: Result, name: str) -> tuple[int, PlanStep]:
    """Index and step of the first step with an action of that name."""
    return next((k, s) for k, s in enumerate(given.plan or ()) if s.action == name)


def moved(given: Result, name: str, epoch: int) -> Result:
    """``given`` with one action moved to another epoch."""
    index, old = step(given, name)
    return with_steps(given, (index, replace(old, epoch=epoch)))
