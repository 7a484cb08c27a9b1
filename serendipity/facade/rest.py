"""The rest of a plan that was begun, beside an answer from the present state (docs/semantics.md)."""

from search import WarmStart
from serendipity.model.answers.answer import Answer
from serendipity.model.numbers import total
from serendipity.model.options import Options
from serendipity.model.task.task import Task


def is_better(rest: WarmStart, answer: Answer, task: Task, options: Options) -> bool:
    """Whether finishing what was begun is better than an answer, and a plan beside the same human plan.

    Args:
        rest: what is left; so far all has gone as planned.
        answer: a feasible one.
        task: from the present state.
    """
    if answer.cost is None or answer.objective is None or answer.human_plan is None:
        return False
    plan, window = [task.actions[i].name for i in answer.human_plan], rest.window
    steps = [(step.epoch, task.actions[step.action]) for step in rest.steps]
    cost = total(task.team_cost(action, options.discount) for _, action in steps)
    if options.max_cost is not None and cost > answer.cost:
        return False  # it may be more than is allowed
    his = [(epoch, action) for epoch, action in steps if task.human in action.participants]
    announced = total(action.cost for _, action in his if action.name not in plan)
    paid = cost + options.communication_weight * announced
    if not options.windowed:
        return paid < answer.objective
    prefix = [action.name for epoch, action in his if window is None or epoch < window.start]
    if not (set(prefix) <= set(plan) if options.keep_prefix else prefix == plan[: len(prefix)]):
        return False
    if not answer.opportunity:  # a better plan of the human's alone is no help
        return cost < answer.cost - (answer.saving_alone or 0)
    length = 0 if window is None else len(window)
    return (paid + options.window_weight * length, cost) < (answer.objective, answer.cost)


def not_now(answer: Answer, limit: str) -> Answer:
    """An answer without its plan, since a limit came before a better one was sure."""
    return Answer(
        "unknown",
        human_plan=answer.human_plan,
        horizon=answer.horizon,
        reason=limit,
        lower_bound=answer.lower_bound,
        baseline=answer.baseline,
        expanded=answer.expanded,
        generated=answer.generated,
    )
