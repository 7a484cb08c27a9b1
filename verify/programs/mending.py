"""What a program's solution stands for: a plan, with an optimal plan of the human's as its suffix."""

from serendipity.model import HumanPlan, Step, Window
from verify.base.due import filled
from verify.base.execution import State, grouped, states_along
from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import PricedPlan, Subproblem


def replay(question: Subproblem, steps: tuple[Step, ...]) -> list[State] | None:
    """States ``s_0 .. s_T`` of a plan, or None if it is not executable or misses a goal."""
    task, sets = question.task, grouped((step.epoch, step.action) for step in steps)
    epochs = (sets.get(epoch, ()) for epoch in range(1, question.horizon + 1))
    states = states_along(task, epochs, strict=question.options.strict)
    return states if states is not None and question.goal.holds(states[-1]) else None


def mended(
    question: Subproblem,
    steps: tuple[Step, ...],
    window: Window | None,
    states: list[State],
    plans: OptimalPlans,
) -> PricedPlan | None:
    """The plan with an optimal suffix: its own, or another one; None if no optimal suffix fits."""
    if not question.replans or window is None or window.end > question.horizon:
        return PricedPlan(steps, window, *question.measure(steps, window))
    suffix = best_suffix(question, states[window.end - 1], window.end, plans)
    if suffix is None:
        return None
    head = tuple(step for step in steps if step.epoch < window.end)
    whole = head + tuple(Step(window.end + k, i) for k, i in enumerate(suffix))
    if question.task.of_bystanders:
        whole = filled(question.task, whole, question.horizon, strict=question.options.strict)
    found = PricedPlan(whole, window, *question.measure(whole, window))
    return found if question.most is None or found.objective <= question.most else None


def suffix_least(question: Subproblem, state: State, xi2: int, plans: OptimalPlans) -> int | None:
    """What the suffix of :func:`best_suffix` adds to the objective, in units; None: there is none."""
    suffix = best_suffix(question, state, xi2, plans)
    if suffix is None:
        return None
    return sum(question.prices.team[i] + question.prices.talk[i] for i in suffix)


def best_suffix(question: Subproblem, state: State, xi2: int, plans: OptimalPlans) -> HumanPlan | None:
    """The optimal plan alone that is best for the objective and reaches all goals, if it fits."""
    left, strict = question.horizon - xi2 + 1, question.options.strict
    return plans.lasting(state, left, question.goal, question.prices.talk, strict=strict)
