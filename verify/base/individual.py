"""The human alone: (cost, length) of an optimal plan of theirs from a state, by A*."""

from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from typing import Final

from serendipity.model import Deadline, Task
from verify.base.operators import Operator, OwnActions
from verify.base.projection import ProjectedCosts
from verify.base.shortest_paths import PathSearch
from verify.base.undecided import TooManyStatesError, during

_MOST_EXPANSIONS: Final = 200_000

_MANY: Final = 1_000
"""Expansions after which it is worth asking whether the goal can be reached at all."""

State = frozenset[int]


class IndividualOptimum:
    """Optimal (cost, length) of the human alone; tables are built when first needed.

    Args:
        task: the task.
        deadline: polled by every question; None for no limit.
    """

    def __init__(self, task: Task, deadline: Deadline | None = None) -> None:
        self._task = task
        self.deadline = deadline or Deadline()
        self._known: dict[int, tuple[Fraction, int] | None] = {}

    @cached_property
    def _own(self) -> OwnActions:
        return OwnActions(self._task, self.deadline)

    @cached_property
    def _projection(self) -> ProjectedCosts:
        return ProjectedCosts(self._task, self._own, self.deadline)

    def optimum(self, state: State) -> tuple[Fraction, int] | None:
        """Least (cost, number of actions) from ``state``; None if the human can't reach ``G_H`` alone.

        Raises:
            TooManyStatesError: the limit on expansions came first.
            LimitReachedError: the deadline did.
        """
        if self._task.goal.holds(state):
            return Fraction(0), 0
        start = self._own.bits.of(state)
        if start not in self._known:
            with during("searching for what the human can do alone"):
                weight = self._search(start)
            self._known[start] = None if weight is None else self._own.split(weight)
        return self._known[start]

    def _search(self, start: int) -> int | None:
        own, goal = self._own, self._task.goal
        wanted, unwanted = own.bits.of(goal.positive), own.bits.of(goal.negative)
        search = PathSearch(start, self._successors, self._projection.bound, self.deadline)
        for expansions, (state, _) in enumerate(search):
            if state & wanted == wanted and not state & unwanted:
                return search.distance[state]
            if expansions == _MANY and not own.may_reach(start, goal, self.deadline):
                return None
            if expansions >= _MOST_EXPANSIONS:
                raise TooManyStatesError
        return None

    def _successors(self, state: int) -> Iterator[tuple[int, int, Operator]]:
        for operator in self._own.applicable(state):
            yield state & ~operator.delete | operator.add, operator.weight, operator
