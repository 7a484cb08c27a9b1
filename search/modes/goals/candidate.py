"""Candidate goals of the human, with plans and probabilities."""

from dataclasses import dataclass
from fractions import Fraction

from serendipity.model.task.actions import Condition
from serendipity.model.task.task import HumanPlan


@dataclass(frozen=True, slots=True)
class Candidate:
    """A goal that the human may have.

    Attributes:
        goal: the goal.
        plan: their current plan, if that is their goal.
        weight: its probability, more than 0.
        name: for people.
    """

    goal: Condition
    plan: HumanPlan
    weight: Fraction
    name: str = ""
