"""What whoever decides for the robots gets to see, and has to be able to do."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Protocol

from serendipity.execution.decided import Decided
from serendipity.execution.world import World
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import PlanStep


class Outlook(NamedTuple):
    """What robots see when they decide.

    Attributes:
        epoch: the epoch that is to come.
        world: the world.
        running: what they have begun and not finished.
    """

    epoch: int
    world: World
    running: tuple[PlanStep, ...]


class Robots(Protocol):
    """Whoever decides for the robots."""

    @property
    def goals(self) -> Mapping[str, float]:
        """The posterior of each candidate goal; empty where there is only one."""

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """What robots do in the epoch that is to come.

        Raises:
            LimitReachedError: the deadline came first; robots had better do nothing.
        """

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """Take in an epoch, by action ids.

        Args:
            own: what the person did alone, or None.
            executed: everything that took place.
            tried: what the person tried alone in vain, or None.
        """

    def surprised(self) -> None:
        """The world is other than what actions have made it."""

    def drop(self, robots: Iterable[int]) -> None:
        """Robots, by agent ids, are out of order: nothing that they take part in is possible any more."""

    def unable(self, actions: Iterable[int]) -> None:
        """Actions, by id, have turned out to be more than robots can do."""
