"""The posterior over goals, worked out once more (semantics 8, after Ramirez and Geffner 2010).

Observations are compiled into the task, as the authors did: a counter says how many of them
have been matched, so ``cost(G, O)`` and ``cost(G, not O)`` are optima of ordinary tasks.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from serendipity.model import Condition, Deadline, GroundAction, Task
from serendipity.model.answers.recognition import GoalPosterior, Recognition
from verify.base.individual import IndividualOptimum
from verify.base.optimal_plans import OptimalPlans
from verify.scenarios.reading import condition

Fault = str
"""One line: what is wrong."""

PlanNames = tuple[str, ...]

Costs = tuple[Fraction | None, Fraction | None]
"""``cost(G, O)`` and ``cost(G, not O)`` of a goal; None where there is no such plan."""


def compiled(
    task: Task, goal: Condition, observed: Sequence[str], deadline: Deadline, *, embed: bool
) -> Task:
    """The human's own task, in which plans have to embed the observations, or must not.

    Matching each observation as early as possible decides whether a plan embeds them.

    Args:
        task: the task.
        goal: the goal of the candidate.
        observed: names of the observed actions, in order.
        deadline: polled.
        embed: whether plans have to embed them, or must not.
    """
    first, last = len(task.facts), len(task.facts) + len(observed)
    actions: list[GroundAction] = []
    for i in deadline.each(task.human_actions):
        action = task.actions[i]
        steps = [first + k for k, name in enumerate(observed) if name == action.name]
        actions.append(replace(action, neg=(*action.neg, *steps)))
        for at in steps:
            pre, add, delete = (*action.pre, at), (*action.add, at + 1), (*action.delete, at)
            actions.append(replace(action, pre=pre, add=add, delete=delete))
    wanted = (
        Condition((*goal.positive, last), goal.negative)
        if embed
        else Condition(goal.positive, (*goal.negative, last))
    )
    return replace(
        task,
        facts=(*task.facts, *(f"matched {k}" for k in range(len(observed) + 1))),
        init=task.init | {first},
        goal=wanted,
        robot_goal=Condition(),
        actions=tuple(actions),
    )


def considered_plans(
    task: Task, goal: Condition, observed: Sequence[str], deadline: Deadline
) -> Iterator[PlanNames]:
    """The optimal plans for a goal that embed the observations, the canonical one first.

    Args:
        task: the task.
        goal: the goal of the candidate.
        observed: names of the observed actions, in order.
        deadline: polled.
    """
    own = compiled(task, goal, observed, deadline, embed=True)
    for plan in OptimalPlans(own, IndividualOptimum(own, deadline)).plans():
        yield tuple(own.actions[i].name for i in plan)


def faults(task: Task, recognised: Recognition, deadline: Deadline) -> Iterator[Fault]:
    """Everything that is wrong with a recognition, in order.

    Args:
        task: the task.
        recognised: what the answer says of goals and observations.
        deadline: polled.
    """
    for name in recognised.observed:
        if all(task.actions[i].participants != (task.human,) for i in task.named.get(name, ())):
            yield f"observed: '{name}' is not an action that the human does alone"
            return
    if recognised.noise or any(goal.errors for goal in recognised.goals):
        yield "noise: plans rest on observations without any"
    if not recognised.goals or not _close(float(sum(goal.prior for goal in recognised.goals)), 1.0):
        yield "the priors do not add up to 1"
    if len({goal.name for goal in recognised.goals}) < len(recognised.goals):
        yield "two goals have one name"
    costs = [_costs(task, recognised, goal, deadline) for goal in recognised.goals]
    for goal, least in zip(recognised.goals, costs, strict=True):
        yield from _own_faults(task, recognised, goal, least, deadline)
    possible = any(goal.prior and goal.with_observed is not None for goal in recognised.goals)
    if recognised.explained != possible:
        yield f"explained is {str(possible).lower()}, the answer says otherwise"
        return
    for goal, right in zip(recognised.goals, _posteriors(recognised, costs), strict=True):
        if not _close(goal.posterior, right):
            yield f"goal '{goal.name}': the posterior is {right:.12g}, the answer says {goal.posterior:.12g}"


def _costs(task: Task, recognised: Recognition, goal: GoalPosterior, deadline: Deadline) -> Costs:
    """What a goal costs with the observations and without, exactly: their difference may be a small one."""
    found = []
    for embed in (True, False):
        own = compiled(task, condition(task, goal.goal), recognised.observed, deadline, embed=embed)
        worth = IndividualOptimum(own, deadline).optimum(own.init)
        found.append(None if worth is None else worth[0])
    return found[0], found[1]


def _own_faults(
    task: Task, recognised: Recognition, goal: GoalPosterior, costs: Costs, deadline: Deadline
) -> Iterator[Fault]:
    for what, said, cost in zip(
        ("with", "without"), (goal.with_observed, goal.without_observed), costs, strict=True
    ):
        least = None if cost is None else float(cost)
        if (None if said is None else float(said)) != least:
            yield f"goal '{goal.name}': its cost {what} the observations is {least}, the answer says {said}"
            return
    wanted = condition(task, goal.goal)
    if goal.plan != next(considered_plans(task, wanted, recognised.observed, deadline), None):
        yield f"goal '{goal.name}': the plan is not the canonical one that explains the observations"
    likelihood = _likelihood(recognised.beta, costs)
    if (likelihood is None) != (goal.likelihood is None) or not _close(goal.likelihood or 0, likelihood or 0):
        yield f"goal '{goal.name}': the likelihood is {likelihood}, the answer says {goal.likelihood}"


def _likelihood(beta: float, costs: Costs) -> float | None:
    """``P(O|G) = 1 / (1 + exp(-beta (cost(G, not O) - cost(G, O))))``; None where both are infinite."""
    with_observed, without_observed = costs
    if with_observed is None:
        return None if without_observed is None else 0.0
    if without_observed is None:
        return 1.0
    loss = beta * float(with_observed - without_observed)
    return 1 / (1 + math.exp(loss)) if loss < 700 else 0.0


def _posteriors(recognised: Recognition, costs: Sequence[Costs]) -> list[float]:
    """Bayes' rule, by logarithms of likelihoods, since a dear detour's would be rounded to 0.

    They are compared before priors count: beside a large one the logarithm of a prior loses its digits.
    """
    if not recognised.explained:
        return [float(goal.prior) for goal in recognised.goals]
    logs = [_log_likelihood(recognised.beta, least) for least in costs]
    most = max(log for log, goal in zip(logs, recognised.goals, strict=True) if goal.prior)
    # A goal without a prior has no share, however likely what was observed is for it.
    shares = [
        float(goal.prior) * math.exp(min(log - most, 0.0))
        for log, goal in zip(logs, recognised.goals, strict=True)
    ]
    return [share / sum(shares) for share in shares]


def _log_likelihood(beta: float, costs: Costs) -> float:
    with_observed, without_observed = costs
    if with_observed is None:
        return -math.inf
    if without_observed is None:
        return 0.0
    loss = beta * float(with_observed - without_observed)
    return -(max(loss, 0.0) + math.log1p(math.exp(-abs(loss))))


def _close(a: float | Fraction, b: float | Fraction) -> bool:
    return math.isclose(a, b, rel_tol=1e-11, abs_tol=1e-12)
