"""The one suffix that the human takes after a window: the canonical one of rule 3 (semantics 3.1, 11)."""

from fractions import Fraction
from functools import cache
from typing import Protocol

from serendipity.model import Deadline, HumanPlan, Options, Task
from verify.base.execution import State, after, applicable, facts_of_his, states_of_pi_h
from verify.base.optimal_plans import OptimalPlans


class Suffix(Protocol):
    """A rule for suffixes; an index says which part of ``pi_H`` is left to them.

    Attributes:
        facts: all that matters of a state.
    """

    facts: State

    def begin(self, state: State, start: int, left: int) -> int | None:
        """The index after a window that began at ``start``; None: none fits into the epochs that are left."""

    def step(self, state: State, index: int, left: int) -> tuple[int | None, int]:
        """The next action, if there is one, and the index after it."""

    def cost(self, state: State, index: int, left: int) -> Fraction:
        """What is left to pay."""


class ReplannedSuffix:
    """The canonical optimal plan from the state that the window leaves."""

    def __init__(self, plans: OptimalPlans) -> None:
        self._plans, self.facts = plans, plans.alone.own.facts

    def begin(self, state: State, start: int, left: int) -> int | None:
        """See :class:`Suffix`."""
        del start
        worth = self._plans.worth(state)
        return None if worth is None or worth[1] > left else 0

    def step(self, state: State, index: int, left: int) -> tuple[int | None, int]:
        """See :class:`Suffix`."""
        del left
        return next(self._plans.steps(state), (None, state))[0], index

    def cost(self, state: State, index: int, left: int) -> Fraction:
        """See :class:`Suffix`."""
        del index, left
        worth = self._plans.worth(state)
        assert worth is not None, "a window has closed here"
        return worth[0]


class PlannedSuffix:
    """What is left of ``pi_H``: the cheapest part, of those the shortest, then the first by names.

    Args:
        task: the task.
        plan: ``pi_H``.
        deadline: polled.
        literal: whether the state has to be as the plan would have made it, and all that follows is done.
    """

    def __init__(self, task: Task, plan: HumanPlan, deadline: Deadline, *, literal: bool) -> None:
        self._task, self._plan, self._literal = task, plan, literal
        self.facts = frozenset(range(len(task.facts)))
        his = facts_of_his(task, deadline)
        self._expected = [state & his for state in states_of_pi_h(task, plan, deadline)]
        self._rest = cache(self._best)

    def begin(self, state: State, start: int, left: int) -> int | None:
        """See :class:`Suffix`."""
        fitting = []
        for index in range(start - 1, len(self._plan) + 1) if self._literal else (0,):
            rest = self._rest(state, index, left)
            if rest is not None and (not self._literal or state >= self._expected[index]):
                fitting.append((self._order(rest), index))
        return min(fitting)[1] if fitting else None

    def step(self, state: State, index: int, left: int) -> tuple[int | None, int]:
        """See :class:`Suffix`."""
        rest = self._rest(state, index, left)
        return (self._plan[rest[0]], rest[0] + 1) if rest else (None, index)

    def cost(self, state: State, index: int, left: int) -> Fraction:
        """See :class:`Suffix`."""
        return self._order(self._rest(state, index, left) or ())[0]

    def _best(self, state: State, index: int, left: int) -> tuple[int, ...] | None:
        """Indices of what the human still does, from one on; None: that is no way to the goal."""
        size, found = len(self._plan), list[tuple[int, ...]]()
        if self._task.goal.holds(state) and (index == size or not self._literal):
            found.append(())
        for k in range(index, min(size, index + 1 if self._literal else size) if left else 0):
            action = self._task.actions[self._plan[k]]
            if applicable(action, state):
                rest = self._rest(after(state, action), k + 1, left - 1)
                if rest is not None:
                    found.append((k, *rest))
        return min(found, key=self._order, default=None)

    def _order(self, rest: tuple[int, ...]) -> tuple[Fraction, int, list[str]]:
        actions = [self._task.actions[self._plan[k]] for k in rest]
        return sum((a.cost for a in actions), Fraction(0)), len(rest), [a.name for a in actions]


def suffix_of(task: Task, options: Options, plan: HumanPlan, plans: OptimalPlans) -> Suffix:
    """The rule that is in force in a scenario, whose plan is ``plan``, beside the human's optimal ones."""
    literal = options.preservation == "state"
    if literal or options.suffix == "subplan":
        return PlannedSuffix(task, plan, plans.deadline, literal=literal)
    return ReplannedSuffix(plans)


def planned(task: Task, suffix: Suffix, state: State, start: int, left: int) -> list[str] | None:
    """The names of a whole suffix; None where none fits."""
    index, names = suffix.begin(state, start, left), list[str]()
    while index is not None and left:
        step, index = suffix.step(state, index, left)
        if step is None:
            break
        names.append(task.actions[step].name)
        state, left = after(state, task.actions[step]), left - 1
    return None if index is None else names
