"""Answers where the human's goal is not known (semantics 8).

Epoch 1 is the first epoch of the human's plans, and observations are actions of those plans:
their current plan for a goal is the canonical optimal plan from ``I`` that embeds them.
"""

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Final

from search.modes.goals import Candidate, explanations, solve_expected
from serendipity.facade import ties
from serendipity.facade.call import Request, Solver
from serendipity.model import Deadline, HumanPlan, Options, Task, UsageError
from serendipity.model.answers.answer import Answer, ServedGoal
from serendipity.model.answers.recognition import Recognition
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.numbers import Number
from serendipity.recognition.recognise import (
    CandidateGoal,
    GoalsGiven,
    ObservedGiven,
    candidate_goals,
    observed_actions,
    posterior,
    strictness,
)

_FIXED: Final[dict[str, object]] = {"ties": "fixed", "human_model": "omniscient", "max_cost": None}
"""Options that have one value only where there are several goals."""


def settled(
    call: Request, goals: GoalsGiven, observed: ObservedGiven, beta: Number
) -> tuple[Request, Solver]:
    """The call that is left once the posterior is known, and its solver.

    With several goals that is the robots' plan of least expected cost; with one, section 3 for
    that goal.  Goals of posterior 0, or that the human can't reach alone, are not considered.
    Without the time for the posterior the answer is ``unknown``, and has none of that.

    Raises:
        InputError: a file or an entry of it is wrong.
        UsageError: an option that has no meaning here.
    """
    task, options = call.task, call.options
    candidates = candidate_goals(task, goals)
    names = observed_actions(task, observed)
    if len(candidates) > 1:
        _refuse(task, options)
    try:
        recognition, plans = _recognised(task, candidates, names, strictness(beta), call.deadline)
    except LIMITS as limit:
        unknown = Answer("unknown", reason=limit_reason(limit), expanded=None, generated=None)
        return call, lambda _: iter((unknown,))
    considered = _considered(candidates, recognition, plans)
    if not considered:
        nothing = Answer("infeasible", reason="no-human-plan", expanded=None, generated=None, goals=())
        return call, lambda _: iter((nothing._replace(recognition=recognition),))
    if len(considered) == 1:
        return _about(call, considered[0], recognition), partial(_certain, considered[0], recognition)
    return call, partial(_expected, considered, recognition)


def asked_about(task: Task, goals: GoalsGiven, observed: ObservedGiven, beta: Number) -> Hashable:
    """The identity of a question about goals.

    Raises:
        InputError: a file or an entry of it is wrong.
    """
    return candidate_goals(task, goals), observed_actions(task, observed), strictness(beta)


def _recognised(
    task: Task,
    candidates: Sequence[CandidateGoal],
    observed: tuple[str, ...],
    beta: float,
    deadline: Deadline,
) -> tuple[Recognition, list[HumanPlan | None]]:
    """The posterior, and for each goal the plan of the human's that is considered.

    Raises:
        LimitReachedError: the deadline ran out.
    """
    conditions = [candidate.goal for candidate in candidates]
    found = explanations(task, conditions, observed, deadline)
    recognition = posterior(task, candidates, observed, found, beta)
    if not recognition.explained:  # the human's plans, as if nothing had been observed
        found = explanations(task, conditions, (), deadline)
    return recognition, [explanation.plan for explanation in found]


def _considered(
    candidates: Sequence[CandidateGoal], recognition: Recognition, plans: Sequence[HumanPlan | None]
) -> list[Candidate]:
    """The goals that are possible and that the human can reach alone; their probabilities add up to 1."""
    possible = [
        (candidate, known, plan)
        for candidate, known, plan in zip(candidates, recognition.goals, plans, strict=True)
        if plan is not None and known.weight > 0
    ]
    total = sum(known.weight for _, known, _ in possible)
    return [Candidate(goal.goal, plan, known.weight / total, goal.name) for goal, known, plan in possible]


def _refuse(task: Task, options: Options) -> None:
    for name, value in _FIXED.items():
        if getattr(options, name) != value:
            raise UsageError(f"{name}: with several goals only {value!r} is possible")
    if task.robot_goal:
        raise UsageError("goals: robots that have goals of their own can be asked about one goal only")


def _about(call: Request, candidate: Candidate, recognition: Recognition) -> Request:
    """The call of section 3 for one goal, with the plan that explains the observations."""
    prepared = call.prepared.with_goal(candidate.goal)
    if not (recognition.observed and recognition.explained):
        return replace(call, prepared=prepared)
    task = prepared.task
    given = task.plan_from_names(task.actions[i].name for i in candidate.plan)
    return replace(call, prepared=prepared, given=given, options=call.options.but(ties="fixed"))


def _certain(candidate: Candidate, recognition: Recognition, call: Request) -> Iterator[Answer]:
    """One goal is left."""
    for answer in ties.answers(call):
        plan = answer.human_plan
        served = ServedGoal(candidate.name, Fraction(1), plan, answer.steps, answer.window, answer.cost)
        yield answer._replace(recognition=recognition, goals=(served,))


def _expected(considered: Sequence[Candidate], recognition: Recognition, call: Request) -> Iterator[Answer]:
    """Several goals are left."""
    answer = solve_expected(call.prepared, call.options, considered, call.deadline)
    yield answer._replace(recognition=recognition)
