"""Questions and answers about several candidate goals, in the model's terms."""

from dataclasses import dataclass
from fractions import Fraction

from serendipity.model.actions import Condition
from serendipity.model.plans import Step, Window
from serendipity.model.task import HumanPlan


@dataclass(frozen=True, slots=True)
class Candidate:
    """A goal that the human may have.

    Attributes:
        goal: the goal.
        plan: their current plan, if that is their goal.
        weight: its probability, more than 0.
    """

    goal: Condition
    plan: HumanPlan
    weight: Fraction


@dataclass(frozen=True, slots=True)
class ServedGoal:
    """What happens if one candidate is the human's goal.

    Attributes:
        steps: what everybody does.
        window: in which their plan is interrupted, or None where it is left alone.
        cost: what it costs the team.
    """

    steps: tuple[Step, ...]
    window: Window | None
    cost: Fraction


@dataclass(frozen=True, slots=True)
class Expected:
    """The robots' plan for all candidates at once.

    Attributes:
        status: ``optimal`` (proved) or ``feasible`` (the limit came first).
        horizon: ``T``, the same for all candidates.
        robots: what robots do by themselves, whatever the goal is.
        served: per candidate what happens then.
        cost: expected cost for the team.
        baseline: expected cost of the human's plans, robots idle.
        saving_alone: what the human gains alone, if their plans are not optimal.
        objective: expected cost and window.
        lower_bound: no plan has a smaller objective.
        opportunity: the robots' plan is cheaper than doing nothing.
        expanded: nodes expanded, those for single candidates included.
        generated: nodes generated, likewise.
    """

    status: str
    horizon: int
    robots: tuple[Step, ...]
    served: tuple[ServedGoal, ...]
    cost: Fraction
    baseline: Fraction
    saving_alone: Fraction
    objective: Fraction
    lower_bound: Fraction
    opportunity: bool
    expanded: int
    generated: int
