"""What a plan for one goal comes to if the goal is another: help under doubt."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from serendipity.execution.advice import Advice
from serendipity.execution.hypotheses import Hypothesis
from serendipity.model import Deadline, PlanStep
from serendipity.model.task.execution import steps_named


@dataclass(frozen=True, slots=True)
class Prospect:
    """One of the goals that the person may have, and the best plan for it.

    Attributes:
        goal: index of the goal.
        hypothesis: what is so if it is theirs.
        advice: the plan, from the present state; None where there was none in time.
        weight: how probable the goal is.
    """

    goal: int
    hypothesis: Hypothesis
    advice: Advice | None
    weight: Fraction

    @property
    def plan(self) -> tuple[PlanStep, ...]:
        """What everybody does by that plan, its epochs counted from the one that is to come."""
        return () if self.advice is None else self.advice.plan

    @property
    def pays(self) -> bool:
        """Whether there is a plan in which robots do something that is worth it."""
        return self.advice is not None and self.advice.pays

    @property
    def open(self) -> bool:
        """Whether robots have a part in such a plan that is still to come."""
        return self.advice is not None and self.pays and not self.advice.by_themselves(self.hypothesis.task)

    @property
    def alone(self) -> Fraction | None:
        """What the person pays without help; None where they have no plan."""
        return self.hypothesis.following.alone


def best_for_all(prospects: Sequence[Prospect], deadline: Deadline) -> Prospect | None:
    """The prospect whose robots' part costs least in the mean over all goals; None if none beats idling.

    Robots' actions are played against the person with each of the goals, by what is known of how they
    react.  Robots can still change their mind when they know more, so the mean is what a plan is good
    for at least.

    Raises:
        LimitReachedError: the deadline came first.
    """
    best = None
    least = sum((p.weight * (p.alone or 0) for p in prospects), Fraction(0))
    for prospect in prospects:
        if prospect.pays:
            cost = _mean(prospect, prospects, least, deadline)
            if cost is not None and cost < least:
                best, least = prospect, cost
    return best


def _mean(
    chosen: Prospect, prospects: Sequence[Prospect], least: Fraction, deadline: Deadline
) -> Fraction | None:
    """The mean cost of a prospect's robots' part, as far as it is below ``least``; None: a goal is missed."""
    task = chosen.hypothesis.task
    steps = steps_named(task, chosen.plan)
    total = Fraction(0)
    for other in prospects:
        companion = other.hypothesis.companion
        start = other.hypothesis.following.start_of(companion.human)
        played = companion.played(start, steps, deadline)
        deadline.check()
        if not played.goals_hold:
            return None
        total += other.weight * played.cost
        if total >= least:
            break
    return total
