"""How a round is played: the task, what its person sees, and what its robots do."""

from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Final

import serendipity
from serendipity.live.play.labels import DomainLabels
from serendipity.model import HumanModel, Task

if TYPE_CHECKING:
    from serendipity.recognition import GoalsGiven

VIEWS: Final = ("observant", "local")
"""What the person sees: everything, or what is where they are."""

CONDITIONS: Final = {
    "none": "robots do nothing",
    "silent": "robots help and say nothing",
    "announced": "robots say what they are going to do, and what the person's part is",
}
"""What robots do."""


@dataclass(frozen=True, slots=True)
class RoundSetting:
    """One round.

    Attributes:
        name: of the scenario.
        task: where it begins; its goal is the person's.
        discount: of robots' costs.
        view: one of ``VIEWS``.
        condition: one of ``CONDITIONS``.
        goals: goals that robots think possible, as :func:`serendipity.recognise` takes them; None: they
            know the person's.
        deadline: seconds for each decision of the robots, or None.
        labels: words for its domain.
        most_epochs: after which it is over, whatever has been reached; None: without end.
    """

    name: str
    task: Task
    discount: Fraction
    view: HumanModel = "observant"
    condition: str = "silent"
    goals: "GoalsGiven | None" = None
    deadline: float | None = None
    labels: DomainLabels = field(default_factory=DomainLabels)
    most_epochs: int | None = None

    def execution(self) -> serendipity.Execution:
        """The round at its beginning.

        Robots that announce what they do have a person before them who knows their plan, and count on it; the
        others take the person for somebody who replans on sight.
        """
        run = serendipity.Execution(
            self.task,
            discount=self.discount,
            human_model=self.view,
            goals=self.goals,
            deadline=self.deadline,
            told=self.condition == "announced",
        )
        if self.condition == "none":
            run.drop(self.task.agents[robot] for robot in self.task.robots)
        return run
