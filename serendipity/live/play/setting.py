"""How a round is played: the task, what its person sees, and what its robots do."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Final

from serendipity.model import Task

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
class Setting:
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
    """

    name: str
    task: Task
    discount: Fraction
    view: str = "observant"
    condition: str = "silent"
    goals: "GoalsGiven | None" = None
    deadline: float | None = None
