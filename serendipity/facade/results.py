"""From exact answers to results: names and floats appear here, and nowhere before."""

from collections.abc import Iterable
from dataclasses import asdict, replace
from fractions import Fraction
from typing import Any

from search.kernel.library import state_at_hand
from serendipity.model import HumanPlan, Options, PlanStep, Result, Step, Task
from serendipity.model.answers.answer import Answer, ServedGoal, Tried
from serendipity.model.answers.result_parts import GapEntry, GoalAnswer, TiedAnswer
from serendipity.model.numbers import figure, rounded
from serendipity.model.task.execution import actions_of, participants, shares
from serendipity.model.task.plans import PlanEntry, PlanTimes, TimedPlan
from serendipity.model.task.plans_in_time import cost_alone, times_of, waited


def to_result(task: Task, options: Options, answer: Answer, elapsed: float) -> Result:
    """An answer in the form that callers see.

    Args:
        task: what was asked; with several goals, its own plays no part.
        elapsed: seconds that it took.
    """
    discount = Fraction(0) if options.mode == "assistance" else options.discount  # semantics 7
    human_cost = answer.baseline if answer.goals else None
    if answer.human_plan is not None:
        human_cost = cost_alone(task, answer.human_plan, options.waiting_cost)
    counted = {"expanded": answer.expanded, "generated": answer.generated}
    return Result(
        mode=options.mode,
        status=answer.status,
        human=task.agents[task.human],
        options=options,
        human_plan=_names(task, answer.human_plan),
        human_plan_times=plan_times(task, answer.human_plan),
        bystanders=_bystanders(task),
        human_cost=rounded(human_cost),
        opportunity=answer.opportunity,
        cost=rounded(answer.cost),
        saving=rounded(answer.saving),
        objective=rounded(answer.objective),
        lower_bound=rounded(answer.lower_bound),
        horizon=answer.horizon,
        window=answer.window,
        reason=answer.reason,
        saving_alone=rounded(answer.saving_alone),
        plan=_plan(task, discount, answer.steps),
        agent_costs=_agent_costs(task, discount, answer, options.waiting_cost),
        realised=dict(answer.realised or {}),
        statistics={
            "elapsed_seconds": elapsed,
            **{name: count for name, count in counted.items() if count is not None},
            "kernel": state_at_hand(),
            **({"strategies": [_tried(row) for row in answer.tried]} if answer.tried else {}),
            **({"proved_by": answer.proved_by} if answer.proved_by else {}),
            **_rule(answer),
            **({"left": {task.facts[f]: float(price) for f, price in answer.left}} if answer.left else {}),
        },
        policy=answer.policy,
        ties=None
        if answer.ties is None
        else tuple(_tied(task, discount, tied, answer.status) for tied in answer.ties),
        optimal_plans=answer.optimal_plans,
        goals=None if answer.goals is None else tuple(_goal(task, discount, goal) for goal in answer.goals),
        recognition=answer.recognition,
        bounds=answer.bounds,
        gap=None
        if answer.gap is None
        else tuple(GapEntry(g.seconds, rounded(g.objective), rounded(g.lower_bound)) for g in answer.gap),
    )


def named_steps(task: Task, discount: Fraction, steps: Iterable[Step]) -> tuple[PlanStep, ...]:
    """Steps with the names of their agents and actions, and what each costs the team."""
    prices: dict[tuple[int, int, bool], float] = {}  # few different ones for many steps
    named = []
    for step in steps:
        action = task.actions[step.action]
        kind = (*action.cost.as_integer_ratio(), task.human in action.participants)
        price = prices.get(kind)
        if price is None:
            price = prices[kind] = figure(task.team_cost(action, discount))
        who = participants(task, action)
        named.append(PlanStep(step.epoch, who, action.name, price, action.duration))
    return tuple(named)


def _names(task: Task, plan: HumanPlan | None) -> tuple[str, ...] | None:
    return None if plan is None else tuple(task.actions[i].name for i in plan)


def plan_times(task: Task, plan: HumanPlan | None) -> PlanTimes | None:
    """The times of a human plan; None where its actions follow one another, an epoch each."""
    if plan is None or not (task.needs_time or isinstance(plan, TimedPlan)):
        return None
    times = times_of(task, plan)
    return None if times.plain else times


def _bystanders(task: Task) -> dict[str, tuple[PlanStep, ...]]:
    """What bystanders do, by name; it costs nobody anything."""
    found: dict[str, list[PlanStep]] = {task.agents[i]: [] for i in sorted(task.script.people)}
    for deed in task.script.deeds:
        if deed.agent in task.script.people:  # and not in the middle of something
            who = task.agents[deed.agent]
            found[who].append(PlanStep(deed.epoch, (who,), deed.name, 0.0, deed.variants[0].duration))
    return {who: tuple(steps) for who, steps in found.items()}


def named_plan(task: Task, plan: HumanPlan) -> tuple[PlanEntry, ...]:
    """A human plan as callers give it: names, with epochs where these say more than their order."""
    names, times = tuple(task.actions[i].name for i in plan), plan_times(task, plan)
    return names if times is None else times.entries(names)


def _plan(task: Task, discount: Fraction, steps: tuple[Step, ...] | None) -> tuple[PlanStep, ...] | None:
    return None if steps is None else named_steps(task, discount, steps)


def _agent_costs(task: Task, discount: Fraction, answer: Answer, waiting: Fraction) -> dict[str, float]:
    """The cost of each agent: the mean with several goals, both totals of a policy."""
    if answer.bounds is not None:
        totals = zip((task.human, *task.robots), answer.bounds.upper or (), strict=False)
        return {task.agents[agent]: figure(cost) for agent, cost in totals}
    if answer.steps is None:
        return {}
    costs = shares(task, actions_of(task, answer.steps), discount)
    if waiting:
        his = ((step.epoch, task.actions[step.action]) for step in answer.steps)
        begun = ((t, a.duration) for t, a in his if task.human in a.participants)
        costs[task.human] += waiting * waited(task, begun)
    if answer.goals is not None and len(answer.goals) > 1:
        costs = dict.fromkeys(costs, Fraction(0))
        for goal in answer.goals:
            for agent, cost in shares(task, actions_of(task, goal.steps or ()), discount).items():
                costs[agent] += goal.probability * cost
    return {task.agents[agent]: figure(cost) for agent, cost in costs.items()}


def _rule(answer: Answer) -> dict[str, Any]:
    """Whether the rule that nobody pays makes a difference, and what it costs."""
    binds: dict[str, Any] = {"rule_binds": True} if answer.is_bound else {}
    if answer.disturbed is not None:
        binds["disturbance"] = float(answer.disturbed)
    if answer.without_rule is None or answer.cost is None:
        return binds
    return {**binds, "rule_binds": answer.is_bound, "rule_price": float(answer.cost - answer.without_rule)}


def _tried(row: Tried) -> dict[str, Any]:
    bound = None if row.bound is None else float(row.bound)
    return {**asdict(row), "seconds": round(row.seconds, 6), "bound": bound}


def _tied(task: Task, discount: Fraction, answer: Answer, status: str) -> TiedAnswer:
    """One of the answers over ties; with its plan where not all is proved, as evidence."""
    names = _names(task, answer.human_plan) or ()
    verdicts, times = dict(answer.realised or {}), plan_times(task, answer.human_plan)
    found = TiedAnswer(names, rounded(answer.cost), answer.opportunity, verdicts, human_plan_times=times)
    if status != "feasible":
        return found
    return replace(found, plan=_plan(task, discount, answer.steps), window=answer.window)


def _goal(task: Task, discount: Fraction, goal: ServedGoal) -> GoalAnswer:
    return GoalAnswer(
        goal.name,
        float(goal.probability),
        _names(task, goal.human_plan),
        rounded(goal.cost),
        goal.window,
        _plan(task, discount, goal.steps),
        plan_times(task, goal.human_plan),
        goal.goal,
    )
