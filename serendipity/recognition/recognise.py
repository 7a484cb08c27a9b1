"""The posterior over the human's goals (semantics 8, after Ramirez and Geffner 2010)."""

import math
from collections.abc import Sequence

from search.modes.goals import Likelihood, explanations
from serendipity.model import Deadline, Task, UsageError, exact
from serendipity.model.answers.recognition import GoalPosterior, Recognition
from serendipity.model.arguments import TASK, expect
from serendipity.model.numbers import Number, as_written
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.limits import limits_from
from serendipity.recognition.candidates import (
    CandidateGoal,
    GoalsGiven,
    ObservedGiven,
    candidate_goals,
    observed_actions,
)


def recognise(
    task: Task,
    goals: GoalsGiven,
    observed: ObservedGiven = (),
    beta: Number = 1,
    *,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Recognition:
    """How probable each candidate goal is, given what the human has done from ``I`` on.

    ``P(O|G) = 1 / (1 + exp(-beta (cost(G, not O) - cost(G, O))))``.  Where only one of the costs
    is finite it is exactly 0 or 1.  Observations are actions of theirs in their order, from the
    task's initial state on; they may have done more between them.

    Args:
        task: the task; its own goal plays no part.
        goals: a file, or a list of ``{"name": ..., "goal": [literals], "prior": ...}``; literals
            are ``"fact"``, ``"!fact"`` or ``"(not (fact))"``.
        observed: a file with an action a line, or a list of names.
        beta: at least 0; 0 learns only from what is impossible.
        time_limit: seconds, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares; it holds beside both limits.

    Raises:
        InputError: a file or an entry in it is wrong; it says where, and what was expected.
        UsageError: ``beta`` or a limit is not a number of at least 0.
        LimitReachedError: a limit came first.  A posterior takes the costs of all goals, so
            there is none then.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(TASK, task=task)
    candidates = candidate_goals(task, goals)
    names = observed_actions(task, observed)
    with no_collection():  # beside a large task a collection takes longer than a short deadline
        found = explanations(task, [candidate.goal for candidate in candidates], names, limits)
    return posterior(task, candidates, names, found, strictness(beta))


def strictness(beta: Number) -> float:
    """``beta`` as a float.

    Raises:
        UsageError: it is not a number of at least 0.
    """
    value = exact(beta, "beta")
    if value < 0:
        raise UsageError(f"beta: expected a number of at least 0, got {float(value):g}")
    return float(value)


def posterior(
    task: Task,
    candidates: Sequence[CandidateGoal],
    observed: tuple[str, ...],
    found: Sequence[Likelihood],
    beta: float,
) -> Recognition:
    """Bayes' rule over the candidates; their priors, if none explains the observations.

    Args:
        task: the task.
        candidates: goals with priors.
        observed: names of the observed actions, in order.
        found: ``cost(G, O)`` and ``cost(G, not O)`` of each candidate, in the same order.
        beta: how strictly the human is taken to minimise cost, per unit of cost.
    """
    logs = [_log_likelihood(explanation, beta) for explanation in found]
    known = [log for log, candidate in zip(logs, candidates, strict=True) if candidate.prior]
    most = max(known)
    explained = most > -math.inf
    # Relative to the best one, so that likelihoods that are equal leave the ratio of the priors exact.
    factors = [math.exp(min(log - most, 0)) if explained else 1.0 for log in logs]
    shares = [
        candidate.prior * as_written(factor) for candidate, factor in zip(candidates, factors, strict=True)
    ]
    total = sum(shares)
    return Recognition(
        human=task.agents[task.human],
        observed=observed,
        beta=beta,
        explained=explained,
        goals=tuple(
            GoalPosterior(
                name=candidate.name,
                goal=candidate.literals,
                prior=candidate.prior,
                likelihood=_likelihood(explanation, log),
                posterior=float(share / total),
                weight=share / total,
                with_observed=explanation.with_observed,
                without_observed=explanation.without_observed,
                plan=None
                if explanation.plan is None
                else tuple(task.actions[i].name for i in explanation.plan),
            )
            for candidate, explanation, log, share in zip(candidates, found, logs, shares, strict=True)
        ),
    )


def _log_likelihood(explanation: Likelihood, beta: float) -> float:
    """``log P(O|G)``: logarithms, because dear detours would be 0 as they are."""
    if explanation.with_observed is None:
        return -math.inf
    if explanation.without_observed is None:
        return 0.0
    gain = beta * float(explanation.without_observed - explanation.with_observed)
    return -math.log1p(math.exp(-gain)) if gain >= 0 else gain - math.log1p(math.exp(gain))


def _likelihood(explanation: Likelihood, log: float) -> float | None:
    if explanation.with_observed is None and explanation.without_observed is None:
        return None
    return math.exp(log)
