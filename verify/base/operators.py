"""The human's own actions as the checker's own search sees them."""

from collections import Counter
from fractions import Fraction
from itertools import chain
from math import lcm
from typing import Final, NamedTuple

from serendipity.model import Deadline, Task

_LONGEST: Final = 10**9
"""More actions than any plan has that is ever compared."""


class Operator(NamedTuple):
    """An own action reduced to the facts that can matter to the human.

    ``weight`` orders plans by cost, then by length: a cost of 1 weighs as much as
    ``_LONGEST`` actions.
    """

    pre: frozenset[int]
    neg: frozenset[int]
    add: frozenset[int]
    delete: frozenset[int]
    weight: int


class OwnActions:
    """The human's own actions, turned into operators when a search first meets them.

    Args:
        task: the task.
        deadline: polled while they are gathered.

    Attributes:
        ids: the actions' ids.
        facts: facts that an own action needs or that their goal names; no other matters to them.
    """

    def __init__(self, task: Task, deadline: Deadline) -> None:
        self._task = task
        self.ids = task.human_actions
        facts = {*task.goal.positive, *task.goal.negative}
        denominators = set()
        for i in deadline.each(self.ids):
            action = task.actions[i]
            facts.update(action.pre, action.neg)
            denominators.add(action.cost.denominator)
        self.facts = frozenset(facts)
        self._unit = lcm(*denominators) * _LONGEST
        self._weights: dict[tuple[int, int], int] = {}
        self._operators: dict[int, Operator] = {}
        self._watched = self._watch(deadline)

    def weight(self, action: int) -> int:
        """The weight of an action."""
        cost = self._task.actions[action].cost
        ratio = (cost.numerator, cost.denominator)
        if ratio not in self._weights:
            self._weights[ratio] = int(cost * self._unit) + 1
        return self._weights[ratio]

    def split(self, weight: int) -> tuple[Fraction, int]:
        """Cost and length of a plan of a weight."""
        length = weight % _LONGEST
        return Fraction(weight - length, self._unit), length

    def applicable(self, state: frozenset[int]) -> list[Operator]:
        """The operators that are applicable in ``state``, which holds relevant facts only."""
        found = []
        for fact in (None, *state):
            for action in self._watched.get(fact, ()):
                operator = self._operator(action)
                if operator.pre <= state and operator.neg.isdisjoint(state):
                    found.append(operator)
        return found

    def _operator(self, action: int) -> Operator:
        if action not in self._operators:
            ground = self._task.actions[action]
            self._operators[action] = Operator(
                frozenset(ground.pre),
                frozenset(ground.neg),
                self.facts.intersection(ground.add),
                self.facts.intersection(ground.delete),
                self.weight(action),
            )
        return self._operators[action]

    def _watch(self, deadline: Deadline) -> dict[int | None, list[int]]:
        """Each action under the precondition that the fewest actions share."""
        actions = self._task.actions
        shared = Counter(chain.from_iterable(actions[i].pre for i in deadline.each(self.ids)))
        watched: dict[int | None, list[int]] = {}
        for i in deadline.each(self.ids):
            rarest = min(actions[i].pre, key=shared.__getitem__, default=None)
            watched.setdefault(rarest, []).append(i)
        return watched
