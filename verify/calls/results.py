"""Answers of the verifier in the model's form."""

from typing import Any

from serendipity.model import PlanStep, Result, Step, Window
from serendipity.model.keywords import Horizon
from serendipity.model.numbers import figure
from verify.base.execution import plan_step, shares
from verify.base.subproblem import PricedPlan
from verify.calls.answer import CallAnswer, idle_cost
from verify.calls.call import ExaminedCall


def plan_steps(call: ExaminedCall, steps: tuple[Step, ...]) -> tuple[PlanStep, ...]:
    """Steps with names and costs, in order."""
    return tuple(plan_step(call.task, step, call.options.discount) for step in sorted(steps))


def found_result(call: ExaminedCall, found: PricedPlan, *, opportunity: bool) -> Result:
    """A plan as a result whose bound is its objective."""
    return _result(call, found.steps, found.window, found.objective, found.cost, opportunity=opportunity)


def to_result(answer: CallAnswer) -> Result:
    """The result that an answer is."""
    call, found = answer.call, answer.found
    if found is not None:
        return found_result(call, found, opportunity=answer.opportunity)
    if answer.cost is None:
        return _infeasible(call, answer.reason)
    baseline = call.baseline
    assert baseline is not None
    if call.robots_goal:
        nothing = call.idle_robots_plan
        assert nothing is not None
        steps = nothing.steps
    else:
        steps = tuple(Step(t, i) for t, i in enumerate(call.human_plan or (), start=1))
    return _result(call, steps, None, baseline, baseline, opportunity=False)


def _result(
    call: ExaminedCall,
    steps: tuple[Step, ...],
    window: Window | None,
    objective: int,
    cost: int,
    *,
    opportunity: bool,
) -> Result:
    exact, least = call.prices.cost(cost), call.prices.cost(objective)
    return Result(
        status="optimal",
        opportunity=opportunity,
        cost=figure(exact),
        saving=_saving(call, cost, opportunity=opportunity),
        objective=figure(least),
        lower_bound=figure(least),
        horizon=_horizon(call),
        window=window,
        saving_alone=_saving_alone(call),
        plan=plan_steps(call, steps),
        agent_costs=_agent_costs(call, steps),
        **_header(call),
    )


def _header(call: ExaminedCall) -> dict[str, Any]:
    task, plan = call.task, call.human_plan
    return {
        "mode": call.options.mode,
        "human": task.agents[task.human],
        "options": call.options,
        "human_plan": None if plan is None else tuple(task.actions[i].name for i in plan),
        "human_cost": None if plan is None else figure(task.cost_of(plan)),
    }


def _infeasible(call: ExaminedCall, reason: str | None) -> Result:
    return Result(status="infeasible", reason=reason, horizon=_horizon(call), **_header(call))


def _horizon(call: ExaminedCall) -> Horizon | None:
    if call.human_plan is None and call.needs_pi_h:
        return None
    return len(call.human_plan or ()) if call.options.mode == "individual" else call.horizon


def _saving(call: ExaminedCall, cost: int, *, opportunity: bool) -> float | None:
    if call.baseline is None:
        return None
    return figure(call.prices.cost(call.baseline - cost)) if opportunity else 0.0


def _saving_alone(call: ExaminedCall) -> float | None:
    if call.baseline is None:
        return None
    idle = idle_cost(call)
    assert idle is not None
    return figure(call.prices.cost(call.baseline - idle))


def _agent_costs(call: ExaminedCall, steps: tuple[Step, ...]) -> dict[str, float]:
    paid = shares(call.task, (step.action for step in steps), call.options.discount)
    return {agent: figure(share) for agent, share in paid.items()}
