"""Results built by hand from tasks and plans, without a planner; tests doctor them."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

from serendipity.model import Options, PlanStep, Result, Task, Window
from serendipity.model.keywords import Horizon
from serendipity.model.numbers import figure


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
    steps, total, talk = [], Fraction(0), Fraction(0)
    shares = dict.fromkeys(task.agents, Fraction(0))
    for epoch, names in plan.items():
        for name in (text.strip() for text in names.split(";")):
            action = by_name[name]
            cost = task.team_cost(action, chosen.discount)
            total += cost
            if chosen.mode == "communication" and task.human in action.participants:
                talk += 0 if name in (human_plan or ()) else chosen.communication_weight * action.cost
            for agent in action.participants:
                shares[task.agents[agent]] += cost / len(action.participants)
            agents = tuple(task.agents[i] for i in action.participants)
            steps.append(PlanStep(epoch, agents, name, figure(cost)))
    human_cost = None if human_plan is None else sum((by_name[n].cost for n in human_plan), Fraction(0))
    objective = total + talk + (0 if window is None else chosen.window_weight * (window[1] - window[0]))
    opportunity = human_cost is not None and total < human_cost
    return Result(
        mode=chosen.mode,
        status="optimal",
        human=task.agents[task.human],
        options=chosen,
        human_plan=human_plan,
        human_cost=None if human_cost is None else figure(human_cost),
        opportunity=opportunity,
        cost=figure(total),
        saving=None if human_cost is None else figure(human_cost - total),
        objective=figure(objective),
        lower_bound=figure(objective),
        horizon=len(human_plan or ()) if horizon is None else horizon,
        window=None if window is None else Window(*window),
        saving_alone=None if human_cost is None else 0.0,
        plan=tuple(steps),
        agent_costs={agent: figure(share) for agent, share in shares.items()},
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
