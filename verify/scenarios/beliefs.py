"""The posterior over goals, worked out once more (semantics 8, after Ramirez and Geffner 2010).

Observations are compiled into the task, as the authors did: a counter says how many of them
have been matched, so ``cost(G, O)`` and ``cost(G, not O)`` are optima of ordinary tasks.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from serendipity.model import Condition, Deadline, GroundAction, Options, Task
from serendipity.model.answers.recognition import GoalPosterior, Recognition
from verify.base.beside_script import alone_of
from verify.base.due import after_waiting, going_on
from verify.base.execution import unchosen
from verify.base.optimal_plans import OptimalPlans
from verify.scenarios.noise import NoiseWeights
from verify.scenarios.reading import condition

Costs = tuple[Fraction | None, Fraction | None]
"""``cost(G, O)`` and ``cost(G, not O)`` of a goal; None where there is no such plan."""


def compiled(
    task: Task, goal: Condition, observed: Sequence[str], deadline: Deadline, *, embed: bool
) -> Task:
    """The task, in which plans of the human's have to embed the observations, or must not.

    Matching each observation as early as possible decides whether a plan embeds them.
    """
    if embed and not observed:
        return task.with_goal(goal, Condition())
    first, last = len(task.facts), len(task.facts) + len(observed)
    actions: list[GroundAction] = []
    numbers: list[int] = []
    for action in deadline.each(task.actions):
        own = action.participants == (task.human,)
        steps = [first + k for k, name in enumerate(observed) if own and name == action.name]
        numbers.append(len(actions))
        actions.append(replace(action, neg=(*action.neg, *steps)))
        for at in steps:
            pre, add, delete = (*action.pre, at), (*action.add, at + 1), (*action.delete, at)
            actions.append(replace(action, pre=pre, add=add, delete=delete))
    positive, negative = ((last,), ()) if embed else ((), (last,))
    return replace(
        task,
        facts=(*task.facts, *(f"matched {k}" for k in range(len(observed) + 1))),
        init=task.init | {first},
        goal=Condition((*goal.positive, *positive), (*goal.negative, *negative)),
        robot_goal=Condition(),
        actions=tuple(actions),
        due=tuple((fact, numbers[i]) for fact, i in task.due),
    )


def considered_plans(
    task: Task, goal: Condition, observed: Sequence[str], options: Options, deadline: Deadline
) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """The optimal plans for a goal that embed the observations, the canonical one first.

    Args:
        observed: names of the observed actions, in order.
        options: which say what disturbs a bystander, and what head start comes before a plan.

    Returns:
        What begins in each plan, which no other shares, and what is done epoch by epoch.
    """
    own = compiled(task, goal, observed, deadline, embed=True)
    goes_on, seen = unchosen(own), set[tuple[str, ...]]()
    for plan in OptimalPlans(own, alone_of(own, deadline, options)).plans():
        begun = tuple(own.actions[i].name for i in plan if i not in goes_on)
        if begun not in seen:
            seen.add(begun)
            busy = len(going_on(own, len(plan), strict=options.strict))
            late = after_waiting(own, plan[busy:], busy + options.head_start, strict=options.strict)
            yield begun, tuple(own.actions[i].name for i in late)


def faults(
    task: Task, recognised: Recognition, options: Options, original: Task, deadline: Deadline
) -> Iterator[str]:
    """All that is wrong with a recognition, in order; the task as it was given says what can be observed."""
    for name in recognised.observed:
        if all(original.actions[i].participants != (task.human,) for i in original.named.get(name, ())):
            yield f"observed: '{name}' is not an action that the human does alone"
            return
    rates = (recognised.noise or {}).values()
    if any(rate > 1 for rate in rates) or (not rates and any(goal.errors for goal in recognised.goals)):
        yield "noise: expected probabilities, and no errors without any"
        return
    if not recognised.goals or not _close(float(sum(goal.prior for goal in recognised.goals)), 1.0):
        yield "the priors do not add up to 1"
    if len({goal.name for goal in recognised.goals}) < len(recognised.goals):
        yield "two goals have one name"
    costs = [_costs(task, recognised, goal, options, deadline) for goal in recognised.goals]
    for goal, least in zip(recognised.goals, costs, strict=True):
        yield from _own_faults(task, recognised, goal, least, options, deadline)
    logs = [
        _log_likelihood(recognised, goal, least) for goal, least in zip(recognised.goals, costs, strict=True)
    ]
    possible = any(goal.prior and log > -math.inf for goal, log in zip(recognised.goals, logs, strict=True))
    if recognised.explained != possible:
        yield f"explained is {str(possible).lower()}, the answer says otherwise"
        return
    for goal, right in zip(recognised.goals, _posteriors(recognised, logs), strict=True):
        if not _close(goal.posterior, right):
            yield f"goal '{goal.name}': the posterior is {right:.12g}, the answer says {goal.posterior:.12g}"


def _costs(
    task: Task, recognised: Recognition, goal: GoalPosterior, options: Options, deadline: Deadline
) -> Costs:
    """What a goal costs with the observations and without, exactly: their difference may be a small one."""
    found: list[Fraction | None] = [None, None]  # every plan embeds nothing
    for k, embed in enumerate((True, False) if recognised.observed else (True,)):
        own = compiled(task, condition(task, goal.goal), recognised.observed, deadline, embed=embed)
        worth = alone_of(own, deadline, options).optimum(own.init)
        found[k] = None if worth is None else worth[0]
    return found[0], found[1]


def _own_faults(
    task: Task,
    recognised: Recognition,
    goal: GoalPosterior,
    costs: Costs,
    options: Options,
    deadline: Deadline,
) -> Iterator[str]:
    for what, said, cost in zip(
        ("with", "without"), (goal.with_observed, goal.without_observed), costs, strict=True
    ):
        least = None if cost is None else float(cost)
        if (None if said is None else float(said)) != least:
            yield f"goal '{goal.name}': its cost {what} the observations is {least}, the answer says {said}"
            return
    wanted = condition(task, goal.goal)
    if recognised.noise:
        if not NoiseWeights(recognised).is_likeliest(task, wanted, goal, options, deadline):
            yield f"goal '{goal.name}': the plan with its errors is not the likeliest reading"
    elif goal.plan != next(considered_plans(task, wanted, recognised.observed, options, deadline), [None])[0]:
        yield f"goal '{goal.name}': the plan is not the canonical one that explains the observations"
    likelihood = None if costs == (None, None) else math.exp(_log_likelihood(recognised, goal, costs))
    if (likelihood is None) != (goal.likelihood is None) or not _close(goal.likelihood or 0, likelihood or 0):
        yield f"goal '{goal.name}': the likelihood is {likelihood}, the answer says {goal.likelihood}"


def _posteriors(recognised: Recognition, logs: Sequence[float]) -> list[float]:
    """Bayes' rule, by logarithms of likelihoods, since a dear detour's would be rounded to 0.

    They are compared before priors count: beside a large one the logarithm of a prior loses its digits.
    """
    if not recognised.explained:
        return [float(goal.prior) for goal in recognised.goals]
    most = max(log for log, goal in zip(logs, recognised.goals, strict=True) if goal.prior)
    # A goal without a prior has no share, however likely what was observed is for it.
    shares = [
        float(goal.prior) * math.exp(min(log - most, 0.0))
        for log, goal in zip(logs, recognised.goals, strict=True)
    ]
    return [share / sum(shares) for share in shares]


def _log_likelihood(recognised: Recognition, goal: GoalPosterior, costs: Costs) -> float:
    """The logarithm of ``P(O|G) = 1 / (1 + exp(-beta (cost(G, not O) - cost(G, O))))``, or with noise."""
    if recognised.noise:
        return NoiseWeights(recognised).log_likelihood(goal.errors, costs)
    with_observed, without_observed = costs
    if with_observed is None:
        return -math.inf
    if without_observed is None:
        return 0.0
    loss = recognised.beta * float(with_observed - without_observed)
    return -(max(loss, 0.0) + math.log1p(math.exp(-abs(loss))))


def _close(a: float | Fraction, b: float | Fraction) -> bool:
    return math.isclose(a, b, rel_tol=1e-11, abs_tol=1e-12)
