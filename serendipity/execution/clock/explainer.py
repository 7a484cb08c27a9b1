"""What explains what was seen of the person, in time: bounds by where it has led (semantics 8)."""

from collections.abc import Sequence
from copy import copy
from fractions import Fraction
from typing import Self

from search import PreparedTask
from search.modes.goals import Explainer, Likelihood
from serendipity.facade.person.ways import Ways
from serendipity.model import Condition, Deadline, Task
from serendipity.model.numbers import total
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.passing import epoch_later


class ExplainerInTime(Explainer):
    """What was done and the optimum from here, beside the optimum from the beginning (Masters and Sardina).

    Args:
        prepared: the task where it begins.
        goals: the candidate goals.

    Attributes:
        now: the task as it stands.
        here: as it would stand, had robots begun nothing in the last epoch; None where nobody knows.
        ways: for each goal, what the person could do alone.
    """

    def __init__(self, prepared: PreparedTask, goals: Sequence[Condition]) -> None:
        self.now = self._begun = prepared.task
        self.here: Task | None = None
        self.ways = list[Ways]()
        self._goals = goals

    def explain(
        self, observed: Sequence[str], deadline: Deadline | None = None, *, canonical: bool = True
    ) -> list[Likelihood]:
        """See :class:`search.modes.goals.Explainer`; no likelihood is above the exact one."""
        now, deadline = self.here or self.now, deadline or Deadline()
        spent = total(now.actions[now.named[name][0]].cost for name in observed)
        before, rest = self._costs(self._begun, deadline), self._costs(now, deadline)
        return [
            Likelihood(None if left is None else spent + left, best, None)
            for best, left in zip(before, rest, strict=True)
        ]

    def from_here(
        self, observed: Sequence[str], state: frozenset[int], deadline: Deadline | None = None
    ) -> list[Likelihood]:
        """The same: there is nothing quicker."""
        return self.explain(observed, deadline)

    def passed(self, own: int | None) -> None:
        """An epoch is over, in which the person has begun an action by that id, or nothing."""
        try:
            self.here = epoch_later(self.now, () if own is None else (self.now.actions[own],))
        except BrokenPlanError:  # what robots were at could not go on beside it
            self.here = None

    def at(self, state: frozenset[int]) -> Self:
        """See :class:`search.modes.goals.Explainer`."""
        moved = copy(self)
        moved._begun = self.now
        return moved

    def _costs(self, task: Task, deadline: Deadline) -> list[Fraction | None]:
        found = [w.of(task.with_goal(g), deadline) for w, g in zip(self.ways, self._goals, strict=True)]
        return [None if way is None else way.cost for way in found]
