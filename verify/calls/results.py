"""Answers of the verifier in the model's form."""

from dataclasses import replace
from typing import Any

from serendipity.model import PlanStep, Result, Step
from serendipity.model.keywords import Horizon
from serendipity.model.numbers import figure
from verify.base.execution import plan_step, shares
from verify.base.subproblem import PricedPlan
from verify.calls.answer import CallAnswer
from verify.calls.call import ExaminedCall
from verify.rules.header import infeasible_because


def plan_steps(call: ExaminedCall, steps: tuple[Step, ...]) -> tuple[PlanStep, ...]:
    """Steps with names and costs, in order."""
    return tuple(plan_step(call.task, step, call.options.discount) for step in sorted(steps))


def found_result(call: ExaminedCall, found: PricedPlan, *, opportunity: bool) -> Result:
    """A plan as a result whose bound is its objective."""
    paid = shares(call.task, (step.action for step in found.steps), call.options.discount)
    least = figure(call.prices.cost(found.objective))
    return Result(
        status="optimal",
        opportunity=opportunity,
        cost=figure(call.prices.cost(found.cost)),
        saving=_saving(call, found.cost if opportunity else call.baseline),
        objective=least,
        lower_bound=least,
        window=found.window,
        saving_alone=_saving(call, None if call.baseline is None else call.idle),
        plan=plan_steps(call, found.steps),
        agent_costs={agent: figure(share) for agent, share in paid.items()},
        **_header(call),
    )


def to_result(answer: CallAnswer) -> Result:
    """The result that an answer is."""
    call = answer.call
    if answer.found is not None:
        return found_result(call, answer.found, opportunity=answer.opportunity)
    if answer.cost is None:
        said = Result(status="infeasible", **_header(call))
        return replace(said, reason=infeasible_because(said))
    assert call.baseline is not None
    if call.robots_goal:
        nothing = call.idle_robots_plan
        assert nothing is not None
        steps = nothing.steps
    else:
        steps = tuple(Step(t, i) for t, i in enumerate(call.human_plan or (), start=1))
    idle = PricedPlan(steps, None, call.baseline, call.baseline)
    return found_result(call, idle, opportunity=False)


def _saving(call: ExaminedCall, cost: int | None) -> float | None:
    """What a cost is less than that of doing nothing; None where that is no answer."""
    if call.baseline is None:
        return None
    assert cost is not None, "as there is one of doing nothing"
    return figure(call.prices.cost(call.baseline - cost))


def _header(call: ExaminedCall) -> dict[str, Any]:
    task, plan = call.task, call.human_plan
    horizon: Horizon | None = None
    if plan is not None or not call.needs_pi_h:
        horizon = len(plan or ()) if call.options.mode == "individual" else call.horizon
    return {
        "mode": call.options.mode,
        "human": task.agents[task.human],
        "options": call.options,
        "horizon": horizon,
        "human_plan": None if plan is None else tuple(task.actions[i].name for i in plan),
        "human_cost": None if plan is None else figure(task.cost_of(plan)),
    }
