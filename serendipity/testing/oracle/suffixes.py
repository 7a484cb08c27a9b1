"""The human's actions after the window (semantics 3.1 rule 3, semantics 3.3)."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache

from serendipity.model import HumanPlan, Options, Task
from serendipity.testing.oracle.alone import Alone
from serendipity.testing.oracle.epochs import State, after, holds, usable
from serendipity.testing.oracle.labels import NOTHING, Front, Label, front, plus

Price = Callable[[int], Label]
"""The cost of an action, as a label."""

Suffix = Callable[[State, int, int], Front]
"""Labels of the suffixes from a state, given xi1 and the number of epochs that are left."""


def suffix_rule(task: Task, options: Options, human_plan: HumanPlan, alone: Alone, price: Price) -> Suffix:
    """The rule in force."""
    if options.preservation == "state":
        return _state(task, human_plan, price)
    if options.suffix == "subplan":
        return _subplan(task, human_plan, price)
    return _replan(task, alone, price)


def _done(task: Task, state: State) -> bool:
    return holds(task.goal, state) and holds(task.robot_goal, state)


def _replan(task: Task, alone: Alone, price: Price) -> Suffix:
    """Def. 2.0a: any optimal plan of the human's own; among several, the best for the objective."""

    @cache
    def best_of(state: State) -> Label | None:
        if holds(task.goal, state) and alone.worth(state) == (Fraction(0), 0):
            return NOTHING if holds(task.robot_goal, state) else None
        rest = [(price(i), best_of(next_state)) for i, next_state in alone.optimal(state)]
        return min((plus(step, label) for step, label in rest if label is not None), default=None)

    def suffix(state: State, _xi1: int, epochs: int) -> Front:
        worth = alone.worth(state)
        if worth is None or worth[1] > epochs:
            return ()
        label = best_of(state)
        return () if label is None else (label,)

    return suffix


def _subplan(task: Task, human_plan: HumanPlan, price: Price) -> Suffix:
    """Def. 2.0: a subsequence of ``pi_H``, each index at most once."""

    @cache
    def from_index(state: State, index: int, epochs: int) -> Front:
        labels = [NOTHING] if _done(task, state) else []
        for k in range(index, len(human_plan)):
            action = task.actions[human_plan[k]]
            if epochs and usable(action, state):
                rest = from_index(after(state, [action]), k + 1, epochs - 1)
                labels += [plus(price(human_plan[k]), label) for label in rest]
        return front(labels)

    return lambda state, _xi1, epochs: from_index(state, 0, epochs)


def _state(task: Task, human_plan: HumanPlan, price: Price) -> Suffix:
    """Def. 3.1 literally: the state entails ``delta(I, pi_H[1..j])``, then ``pi_H[j+1..]``."""
    expected, mentioned = _preserved(task, human_plan)

    def continued(state: State, j: int) -> Front:
        label = NOTHING
        for i in human_plan[j:]:
            if not usable(task.actions[i], state):
                return ()
            state = after(state, [task.actions[i]])
            label = plus(label, price(i))
        return (label,) if _done(task, state) else ()

    @cache
    def suffix(state: State, xi1: int, epochs: int) -> Front:
        labels: list[Label] = []
        for j in range(xi1 - 1, len(human_plan) + 1):
            if len(human_plan) - j <= epochs and state >= (expected[j] & mentioned):
                labels += continued(state, j)
        return front(labels)

    return suffix


def _preserved(task: Task, human_plan: HumanPlan) -> tuple[list[State], set[int]]:
    """The states ``delta(I, pi_H[1..j])``, and the facts that the human's own domain mentions."""
    expected = [task.init]
    for i in human_plan:
        expected.append(after(expected[-1], [task.actions[i]]))
    mentioned = set(task.goal.positive) | set(task.goal.negative)
    for i in task.human_actions:
        action = task.actions[i]
        mentioned |= {*action.pre, *action.neg, *action.add, *action.delete}
    return expected, mentioned


class CanonicalSuffix:
    """The one suffix that the human takes: the cheapest, of those the shortest, of those the first by names.

    Args:
        task: the task.
        options: which rule is in force.
        human_plan: ``pi_H``.
    """

    def __init__(self, task: Task, options: Options, human_plan: HumanPlan) -> None:
        self.task, self.options, self.human_plan = task, options, human_plan
        self.alone = Alone(task)
        self.expected, self.mentioned = _preserved(task, human_plan)
        self.plan = cache(self._plan)

    def _plan(self, state: State, xi1: int, epochs: int) -> HumanPlan | None:
        """From a state on, given xi1 and the number of epochs that are left; None where no window fits."""
        if self.options.preservation == "state":
            found = self._rests(state, xi1)
        elif self.options.suffix == "subplan":
            found = self._parts(state, self.human_plan)
        else:
            found = self._optimal(state)
        return min((plan for plan in found if len(plan) <= epochs), key=self._order, default=None)

    def _order(self, plan: HumanPlan) -> tuple[Fraction, int, list[str]]:
        return (self.task.cost_of(plan), len(plan), [self.task.actions[i].name for i in plan])

    def _optimal(self, state: State) -> Iterator[HumanPlan]:
        """Def. 2.0a: the canonical plan of semantics 1."""
        plan: HumanPlan = ()
        while ways := self.alone.optimal(state):
            plan, state = (*plan, ways[0][0]), ways[0][1]
        if holds(self.task.goal, state):
            yield plan

    def _parts(self, state: State, rest: HumanPlan) -> Iterator[HumanPlan]:
        """Def. 2.0: the subsequences of ``pi_H`` that work."""
        if holds(self.task.goal, state):
            yield ()
        for k, i in enumerate(rest):
            if usable(self.task.actions[i], state):
                for plan in self._parts(after(state, [self.task.actions[i]]), rest[k + 1 :]):
                    yield (i, *plan)

    def _rests(self, state: State, xi1: int) -> Iterator[HumanPlan]:
        """Def. 3.1 literally: ``pi_H[j+1..]``, where the state entails ``delta(I, pi_H[1..j])``."""
        for j in range(xi1 - 1, len(self.human_plan) + 1):
            rest = self.human_plan[j:]
            if state >= (self.expected[j] & self.mentioned) and rest in self._parts(state, rest):
                yield rest
