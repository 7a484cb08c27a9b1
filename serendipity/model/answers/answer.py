"""Exact answers: rationals and ids, as planners find them; results have names and floats."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal, NamedTuple

from serendipity.model.answers.policy import Costs, Policy
from serendipity.model.answers.recognition import Recognition
from serendipity.model.keywords import Horizon
from serendipity.model.task.plans import Step, Window
from serendipity.model.task.task import HumanPlan

Status = Literal["optimal", "feasible", "infeasible", "unknown"]


class Improvement(NamedTuple):
    """Objective and lower bound that were known after some seconds."""

    seconds: float
    objective: Fraction | None
    lower_bound: Fraction | None


@dataclass(frozen=True, slots=True)
class PolicyBounds:
    """Both sides of a policy's value (semantics 7): no policy is worth less, this one (if any) not more."""

    lower: Costs
    upper: Costs | None


@dataclass(frozen=True, slots=True)
class ServedGoal:
    """The answer for one goal that the human may have (semantics 8).

    Attributes:
        human_plan: the human's current plan, if that is their goal; None where that is not known.
        window: in which that plan is interrupted, or None where it is left alone.
        goal: literals of the goal, where neither the task nor a recognition says it.
    """

    name: str
    probability: Fraction
    human_plan: HumanPlan | None
    steps: tuple[Step, ...] | None
    window: Window | None
    cost: Fraction | None
    goal: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Tried:
    """One strategy of a planning call: what it took, and what came of it.

    Attributes:
        better: how often it has made the answer better.
        bound: the lower bound on the objective that it left, where it has raised it; else None.
        settled: whether nothing better was left after it.
    """

    name: str
    seconds: float = field(compare=False)
    better: int
    bound: Fraction | None
    settled: bool


class Answer(NamedTuple):
    """An answer, proved or on the way to it; a named tuple, as a call makes several within microseconds.

    Attributes:
        status: as in :class:`serendipity.model.Result`.
        human_plan: ``pi_H``, or None where the human has no plan alone, or there are several.
        horizon: ``T``, ``"inf"``, or None where none was needed.
        reason: why there is no plan.
        steps: the plan, or None.
        window: its window, or None.
        cost: what it costs the team; in mode ``assistance`` the sum of both totals.
        objective: cost, window and communication.
        lower_bound: no answer has a smaller objective.
        baseline: cost of doing nothing for the human, or None if that is impossible.
        saving: what it costs less than the baseline (in mode ``assistance``, what the human saves).
        saving_alone: cost(pi_H) - cost of the answer with robots idle; None without a plan, or
            while that is not known.
        opportunity: it is cheaper than doing nothing, thanks to a robot.
        expanded: nodes expanded; None where nothing was searched.
        generated: nodes generated; None where they are not counted.
        realised: whether humans who replan realise it, by model; None while nobody has looked.
        ties: the answers for single optimal ``pi_H`` that it was made of; None without ``ties``.
        optimal_plans: how many optimal plans the human has; None where that was not asked.
        recognition: the posterior over the human's goals; None where their goal is known.
        goals: for each goal that is considered what happens then; None where the human's goal is known.
        bounds: both sides of the policy's value; None in other modes.
        policy: of mode ``assistance``, or None.
        gap: how it got better; None where that is not told.
        tried: the strategies that were tried, in their order; empty in modes that have but one.
        without_rule: cost of the best answer without the rule that nobody pays; None where that is not known.
        is_bound: whether it was looked for under that rule, since the best answer without it breaks it.
        disturbed: how much it disturbs the human (semantics 13); None where that was not asked.
        left: priced facts that are left otherwise than without help, each with its price.
        proved_by: the planner of others on whose word it is proved; None for our own.
    """

    status: Status
    human_plan: HumanPlan | None = None
    horizon: Horizon | None = None
    reason: str | None = None
    steps: tuple[Step, ...] | None = None
    window: Window | None = None
    cost: Fraction | None = None
    objective: Fraction | None = None
    lower_bound: Fraction | None = None
    baseline: Fraction | None = None
    saving: Fraction | None = None
    saving_alone: Fraction | None = None
    opportunity: bool = False
    expanded: int | None = 0
    generated: int | None = 0
    realised: Mapping[str, bool] | None = None
    ties: "tuple[Answer, ...] | None" = None
    optimal_plans: int | None = None
    recognition: Recognition | None = None
    goals: tuple[ServedGoal, ...] | None = None
    bounds: PolicyBounds | None = None
    policy: Policy | None = None
    gap: tuple[Improvement, ...] | None = None
    tried: tuple[Tried, ...] = ()
    without_rule: Fraction | None = None
    is_bound: bool = False
    disturbed: Fraction | None = None
    left: tuple[tuple[int, Fraction], ...] = ()
    proved_by: str | None = None


def saved(baseline: Fraction | None, cost: Fraction | None, *, opportunity: bool) -> Fraction | None:
    """The saving of an opportunity beside the baseline, else 0; None without a baseline or a plan."""
    if baseline is None or cost is None:
        return None
    return baseline - cost if opportunity else Fraction(0)
