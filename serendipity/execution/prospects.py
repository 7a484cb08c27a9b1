"""What a plan for one goal comes to if the goal is another: help under doubt."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from search import PreparedTask
from search.simulation import simulate
from serendipity.model.answers.result import Result
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.execution import actions_named
from serendipity.model.task.plans import PlanStep, Step
from serendipity.model.task.task import HumanPlan


@dataclass(frozen=True, slots=True)
class Prospect:
    """The best plan for one of the goals that the person may have.

    Attributes:
        goal: index of the goal.
        result: the plan, from the present state.
        prepared: the task with that goal, in the present state.
        promise: what the person is going to do for that goal, without help.
        weight: how probable the goal is.
    """

    goal: int
    result: Result
    prepared: PreparedTask
    promise: HumanPlan
    weight: Fraction

    @property
    def plan(self) -> tuple[PlanStep, ...]:
        """What everybody does by that plan, its epochs counted from the one that is to come."""
        return self.result.plan or ()

    @property
    def alone(self) -> Fraction:
        """What the person pays without help."""
        return self.prepared.task.cost_of(self.promise)


def best_for_all(prospects: Sequence[Prospect], options: Options, deadline: Deadline) -> Prospect | None:
    """The prospect whose robots' part costs least in the mean over all goals; None if none beats idling.

    Robots' actions are played against the person with each of the goals, by what is known of how they
    react.  Robots can still change their mind when they know more, so the mean is what a plan is good
    for at least.

    Args:
        prospects: one for each goal.
        options: in force.
        deadline: polled.

    Raises:
        LimitReachedError: the deadline came first.
    """
    best = None
    least = sum((p.weight * p.alone for p in prospects), Fraction(0))
    for prospect in prospects:
        if not prospect.result.opportunity:
            continue
        cost = _mean(prospect, prospects, options, deadline)
        if cost is not None and cost < least:
            best, least = prospect, cost
    return best


def _mean(
    chosen: Prospect, prospects: Sequence[Prospect], options: Options, deadline: Deadline
) -> Fraction | None:
    """The mean cost of a prospect's robots' part; None where a person would miss the goal."""
    task = chosen.prepared.task
    steps = [Step(step.epoch, actions_named(task, step.action, step.agents)[0]) for step in chosen.plan]
    total = Fraction(0)
    for other in prospects:
        played = simulate(
            other.prepared,
            options,
            other.promise,
            steps,
            human_model="local" if options.human_model == "local" else "observant",
            horizon=None,
            deadline=deadline,
        )
        deadline.check()
        if not played.goals_hold:
            return None
        total += other.weight * played.cost
    return total
