"""Advice to robots: what they had best do from a moment on, whoever has worked it out."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

from serendipity.execution.guard import Following
from serendipity.model import Deadline, PlanStep, Task, Window

Allows = Callable[[Sequence[int]], bool]
"""Whether actions, those of the person left aside, may be what happens in the epoch that is to come."""


@dataclass(frozen=True, slots=True)
class Advice:
    """A plan from the present moment.

    Attributes:
        plan: what everybody does, its epochs counted from the one that is to come.
        window: where the person is met, as far as the plan says so.
        cost: what it costs the team.
        pays: whether robots do something in it that is worth it.
        proved: whether nothing better is possible.
    """

    plan: tuple[PlanStep, ...]
    window: Window | None
    cost: Fraction
    pays: bool
    proved: bool

    def by_themselves(self, task: Task) -> bool:
        """Whether robots have no part in it."""
        return all(step.agents == (task.agents[task.human],) for step in self.plan)


@dataclass(frozen=True, slots=True)
class DecisionPoint:
    """An epoch that is to come, whichever goal the person has.

    Attributes:
        state: ids of the facts that are true.
        out: ids of actions that nobody can do any more.
        barred: these, and those that wait for what robots have begun to be finished.
        running: ids of what they have begun, and go on with in any case.
        allows: what may happen in it.
    """

    state: frozenset[int]
    out: frozenset[int]
    barred: frozenset[int]
    running: frozenset[int]
    allows: Allows


class Adviser(Protocol):
    """Plans for one goal of the person's."""

    def advise(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Advice | None:
        """The best plan that is found in time; None where there is none.

        Args:
            following: what the person may be following.
            now: where things stand.

        Raises:
            LimitReachedError: the deadline came before there was any.
        """
