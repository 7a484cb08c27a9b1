"""Parts of some answers beside their plan: over ties, for several goals, over time.

In JSON they stand in ``statistics`` (see :class:`serendipity.model.Result`).
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

from serendipity.model.answers.answer import Status
from serendipity.model.answers.fields import Form, Written, form, number, optional, written
from serendipity.model.task.plans import PlanStep, PlanTimes, Window


@dataclass(frozen=True, slots=True)
class TiedAnswer:
    """The answer for one of the human's optimal plans (semantics 1).

    Attributes:
        human_plan: names of ``pi_H``.
        cost: what the answer costs the team, or None without a plan.
        opportunity: whether a robot helps.
        realised: verdicts on humans who replan, by model; None where nobody has looked.
        plan: what everybody does, where it is not proved that nothing is better; else None.
        window: of that plan.
        human_plan_times: of ``pi_H``, as in :class:`serendipity.model.Result`.
    """

    human_plan: tuple[str, ...]
    cost: float | None
    opportunity: bool
    realised: dict[str, bool] | None = None
    plan: tuple[PlanStep, ...] | None = None
    window: Window | None = None
    human_plan_times: PlanTimes | None = None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object, without what is not known of the answer."""
        names = ["human_plan", "cost", "opportunity"]
        names += [] if self.realised is None else ["realised"]
        names += [] if self.plan is None else ["window", "plan"]
        names += [] if self.human_plan_times is None else ["human_plan_times"]
        return written(self, names)


@dataclass(frozen=True, slots=True)
class GoalAnswer:
    """What happens in one scenario (semantics 8, 11).

    Attributes:
        name: of the scenario, or of its goal.
        probability: among the scenarios that are considered.
        human_plan: names of the human's current plan, or None where that is not known.
        cost: what it costs the team, or None without a plan.
        window: in which that plan is interrupted, or None.
        plan: what everybody does, or None.
        human_plan_times: of the human's plan, as in :class:`serendipity.model.Result`.
        goal: literals of what the human wants, where neither the task nor a recognition says it.
    """

    name: str
    probability: float
    human_plan: tuple[str, ...] | None
    cost: float | None
    window: Window | None
    plan: tuple[PlanStep, ...] | None
    human_plan_times: PlanTimes | None = None
    goal: tuple[str, ...] | None = None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        names = ["name", "probability", "human_plan", "cost", "window", "plan"]
        more = (name for name in ("human_plan_times", "goal") if getattr(self, name) is not None)
        return written(self, [*names, *more])


@dataclass(frozen=True, slots=True)
class HelpedPerson(Written):
    """The answer in short where one of several people, ``human``, is helped (``human="any"``)."""

    human: str
    status: Status
    cost: float | None
    saving: float | None


class GapEntry(NamedTuple):
    """Objective and lower bound as they were known after some seconds; None while there was none."""

    seconds: float
    objective: float | None
    lower_bound: float | None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return self._asdict()


form(HelpedPerson, {"saving": optional(Form(number))})
