"""What robots are advised to do from a moment on, whoever has worked it out."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

from serendipity.execution.guard import Following
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import PlanStep, Window

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


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked of an adviser.

    Attributes:
        state: ids of the facts that are true.
        following: what the person may be following.
        barred: ids of actions that nobody may do.
        allows: what may happen in the epoch that is to come.
    """

    state: frozenset[int]
    following: Following
    barred: frozenset[int]
    allows: Allows


class Adviser(Protocol):
    """Plans for one goal of the person's."""

    def advise(self, question: Question, deadline: Deadline) -> Advice | None:
        """The best plan that is found in time; None where there is none.

        Raises:
            LimitReachedError: the deadline came before there was any.
        """

    def again(self) -> "Adviser":
        """The same, which knows what this one knows, and goes its own way from here."""
