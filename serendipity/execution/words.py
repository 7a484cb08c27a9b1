"""Why robots do what they do, in words."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from serendipity.model.numbers import plain
from serendipity.model.task.plans import PlanStep
from serendipity.model.task.task import Task

if TYPE_CHECKING:
    from serendipity.execution.beliefs import Beliefs
    from serendipity.execution.prospects import Prospect

_ASIDE = "stays out of the way"


class Words:
    """Reasons for decisions.

    Args:
        task: the task.
        beliefs: about the person's goal; None where it is known.
    """

    def __init__(self, task: Task, beliefs: "Beliefs | None") -> None:
        self._human = task.agents[task.human]
        self._beliefs = beliefs

    def hopeless(self) -> str:
        """There is nothing to preserve."""
        return f"{_ASIDE}: {self._human} has no plan alone"

    def helpless(self) -> str:
        """Robots can do nothing, or nothing that would spoil nothing."""
        return f"{_ASIDE}: there is nothing that it could do"

    def finishes(self, step: PlanStep) -> str:
        """Robots go on with what they have begun."""
        return f"goes on with {step.action}"

    def nothing(self) -> tuple[str, str]:
        """No plan with help is cheaper, whatever the goal is."""
        return "aside", f"{_ASIDE}: no help pays"

    def unsure(self) -> tuple[str, str]:
        """Help would pay for some goals, and not in the mean."""
        return "unsure", f"waits: not sure which goal ({self._likely()})"

    def decided(self, epoch: int, prospect: "Prospect", now: Sequence[PlanStep]) -> tuple[str, str]:
        """Verdict and reason of a decision that follows a plan.

        Args:
            epoch: the epoch.
            prospect: the plan.
            now: what robots do and offer in this epoch.
        """
        if not prospect.pays:
            return ("works", "sees to goals of its own") if now else self.nothing()
        if now:
            cost = sum(step.cost for step in prospect.plan)
            return "helps", f"helps: {plain(cost)} for the team from here{self._guess(prospect)}"
        later = min((s.epoch for s in prospect.plan if s.agents != (self._human,)), default=None)
        if later is None:
            return "aside", f"{_ASIDE}: all that helps is done"
        part = f"its part comes in epoch {epoch + later - 1}"
        if self._beliefs is not None and len(self._beliefs.possible()) > 1:
            return "unsure", f"waits: not sure which goal ({self._likely()}); {part}"
        return "waits", f"waits: {part}"

    def _likely(self) -> str:
        """The most probable goals."""
        assert self._beliefs is not None, "only a goal that is not known leaves doubts"
        likely = sorted(self._beliefs.named().items(), key=lambda goal: -goal[1])
        return ", ".join(f"{name} {share:.0%}" for name, share in likely[:3])

    def _guess(self, prospect: "Prospect") -> str:
        if self._beliefs is None:
            return ""
        name = self._beliefs.candidates[prospect.goal].name
        return f", taking the goal to be {name} ({float(self._beliefs.weights[prospect.goal]):.0%})"
