"""One planning call as a value, and what an answer to it says."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from serendipity.model import HumanPlan, Options, Task, Window
from serendipity.model.task.plans import PlanEntry
from serendipity.model.task.plans_in_time import times_of


@dataclass(frozen=True, slots=True)
class Call:
    """One planning call: a task, options that are legal for it, ``pi_H`` where it is given."""

    task: Task
    options: Options
    human_plan: HumanPlan | None = None

    @property
    def human_plan_names(self) -> list[str] | None:
        """The given plan as the facade takes it."""
        if self.human_plan is None:
            return None
        return [self.task.actions[i].name for i in self.human_plan]

    @property
    def human_entries(self) -> tuple[PlanEntry, ...] | None:
        """The given plan as the facade takes it, with the epoch in which each action begins."""
        if self.human_plan is None:
            return None
        return times_of(self.task, self.human_plan).entries(self.human_plan_names or ())

    def keywords(self, **changes: Any) -> dict[str, Any]:
        """The options as the facade takes them, each of them, with some changed."""
        return {name: getattr(self.options, name) for name in self.options.to_dict()} | changes


class Answered(Protocol):
    """The answer of a planner, or of brute force."""

    @property
    def status(self) -> str:
        """``optimal``, ``feasible``, ``infeasible`` or ``unknown``."""

    @property
    def cost(self) -> Fraction | float | None:
        """The cost to the team; None without a plan."""

    @property
    def objective(self) -> Fraction | float | None:
        """The objective; None without a plan."""

    @property
    def window(self) -> Window | None:
        """The window of help; None without help, and in modes without windows."""

    @property
    def opportunity(self) -> bool:
        """Whether help pays."""
