"""Results built by hand from tasks and plans, without a planner; tests doctor them."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from serendipity.model import GroundAction, Options, PlanStep, Result, Task, Window
from serendipity.model.keywords import Horizon
from serendipity.model.numbers import figure, rounded, total
from serendipity.model.task.actions import NOOP
from serendipity.model.task.execution import participants, shares
from serendipity.model.task.plans import PlanEntry, PlanTimes
from serendipity.model.task.plans_in_time import waited


def result(
    task: Task,
    plan: Mapping[int, str],
    *,
    human_plan: tuple[PlanEntry, ...] | None,
    window: tuple[int, int] | None = None,
    horizon: Horizon | None = None,
    **options: Any,
) -> Result:
    """An ``optimal`` result with all its figures worked out from the plan.

    Args:
        plan: names of actions by epoch, several separated by ``;``.
        human_plan: names of the actions of ``pi_H``, with epochs where they don't follow one another.
        window: ``(start, end)``; a plan with one is an opportunity.
        horizon: ``T`` or ``"inf"`` where it is asked for; None is the length of ``pi_H``.
        options: of the call, but the horizon.
    """
    chosen = Options(horizon=horizon, **options)
    by_name = {action.name: action for action in task.actions}
    done = [(epoch, by_name[name.strip()]) for epoch, names in plan.items() for name in names.split(";")]
    actions = [action for _, action in done]
    begun = [(t, action.duration) for t, action in done if task.human in action.participants]
    waiting = chosen.waiting_cost * waited(task, begun)
    cost = waiting + total(task.team_cost(action, chosen.discount) for action in actions)
    his = [action for action in actions if task.human in action.participants]
    entries = () if human_plan is None else human_plan
    every = (entry if isinstance(entry, str) else entry[1] for entry in entries)
    names = tuple(name for name in every if name != NOOP)
    times = _times(by_name, entries)
    announced = total(action.cost for action in his if action.name not in names)
    talk = chosen.communication_weight * announced if chosen.mode == "communication" else 0
    human_cost = None
    if human_plan is not None:
        pauses = chosen.waiting_cost * waited(task, zip(times.starts, times.durations, strict=True))
        human_cost = pauses + total(by_name[name].cost for name in names)
    saving = None if human_cost is None else human_cost - cost
    objective = cost + talk + (0 if window is None else chosen.window_weight * (window[1] - window[0]))
    steps = (
        PlanStep(
            epoch,
            participants(task, action),
            action.name,
            figure(task.team_cost(action, chosen.discount)),
            action.duration,
        )
        for epoch, action in done
    )
    agent_costs = shares(task, actions, chosen.discount)
    agent_costs[task.human] += waiting
    return Result(
        mode=chosen.mode,
        status="optimal",
        human=task.agents[task.human],
        options=chosen,
        human_plan=None if human_plan is None else names,
        human_plan_times=None if human_plan is None or times.plain else times,
        human_cost=rounded(human_cost),
        opportunity=saving is not None and saving > 0,
        cost=figure(cost),
        saving=rounded(saving),
        objective=figure(objective),
        lower_bound=figure(objective),
        horizon=times.epochs if horizon is None else horizon,
        window=None if window is None else Window(*window),
        saving_alone=None if human_cost is None else 0.0,
        plan=tuple(steps),
        agent_costs={task.agents[i]: figure(share) for i, share in agent_costs.items()},
    )


def _times(by_name: Mapping[str, GroundAction], entries: Iterable[PlanEntry]) -> PlanTimes:
    """When the actions of a plan begin, and how long they take."""
    starts, durations, end = list[int](), list[int](), 0
    for entry in entries:
        start, name = (end + 1, entry) if isinstance(entry, str) else entry
        end = start
        if name != NOOP:
            starts.append(start)
            durations.append(by_name[name].duration)
            end += durations[-1] - 1
    return PlanTimes(tuple(starts), tuple(durations), end)


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
