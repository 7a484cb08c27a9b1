"""Scenarios that are not told apart, and what robots may do while they are not (semantics 11)."""

from dataclasses import dataclass, field
from typing import NamedTuple

from search.modes.scenarios.lines import Way
from search.modes.scenarios.measure import INFINITE_WORTH, Member
from search.packed.joint_actions import JointAction


class Choice(NamedTuple):
    """What is done in an epoch by a group, and what it leads to.

    Attributes:
        robots: what robots do by themselves.
        ways: what each scenario does, in the order of the group.
        branches: what is paid, and the group after it, for each that is told apart.
    """

    robots: JointAction
    ways: tuple[Way, ...]
    branches: tuple[tuple[int, "Group"], ...]


@dataclass(eq=False, slots=True)
class Group:
    """Scenarios that are not told apart after an epoch, and the bounds on what they have left to pay.

    Attributes:
        epoch: the number of those that are over.
        members: in the order of their numbers.
        lower: no policy is worth less.
        upper: of the best policy known; infinite without one.
        choice: its first epoch; None where it leaves everybody alone, or one scenario goes on for certain.
        choices: those that may be best by their bounds, as a heap; None before it was looked at.
        reach: choices worth as much or more were left out of these.
    """

    epoch: int
    members: tuple[Member, ...]
    lower: int
    upper: int = INFINITE_WORTH
    choice: Choice | None = None
    choices: list[tuple[int, int, Choice]] | None = field(default=None, repr=False)
    reach: int = 0

    @property
    def is_settled(self) -> bool:
        """Whether its best policy is known."""
        return self.lower >= self.upper

    def offer(self, value: int, choice: Choice | None) -> None:
        """A policy that there is."""
        if value < self.upper:
            self.upper, self.choice = value, choice
