"""A task in which what actions add up to is limited: what the human pays, for one (semantics 12, 13).

Search and verifier both look at such tasks.  That they count right is held by the verifier's rule, which adds
up what the human pays in a plan, and by the brute force of the tests, which knows of no such task.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition, GroundAction
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.variables import Variable

_BYTES: Final = 500
"""Of an action; measured."""


class Metered:
    """The task, with facts that say how much has been paid.

    An action that costs anything becomes one for each amount paid before: variants of one name.

    Args:
        task: in single epochs.
        prices: of its actions; None: what the human pays for them.
        name: of what is paid, for the facts.

    Raises:
        LimitReachedError: the deadline came, or all this does not fit into memory.
    """

    def __init__(
        self,
        task: Task,
        most: Fraction,
        deadline: Deadline,
        prices: Sequence[Fraction] | None = None,
        name: str = "paid",
    ) -> None:
        if prices is None:
            prices = [a.cost if task.human in a.participants else Fraction(0) for a in task.actions]
        self._prices = prices
        priced = [price for price in prices if price]
        amounts = _sums(set(priced), most, deadline)
        deadline.require(_BYTES * len(priced) * len(amounts))
        self._facts = facts = {amount: len(task.facts) + number for number, amount in enumerate(amounts)}
        self._original: list[int] = []
        self._ids: dict[int, dict[Fraction, int]] = {}
        actions: list[GroundAction] = []
        for number, action in enumerate(deadline.each(task.actions)):
            ids = self._ids[number] = {}
            for before, variant in self._variants(action, prices[number]):
                ids[before] = len(actions)
                actions.append(variant)
                self._original.append(number)
        self.task = replace(
            task,
            facts=(*task.facts, *(f"~{name} {amount}" for amount in amounts)),
            init=task.init | {facts[Fraction(0)]},
            actions=tuple(actions),
            due=tuple((fact, new) for fact, number in task.due for new in self._ids[number].values()),
            known_variables=(*task.variables, Variable(tuple(facts.values()))),
        )

    def _variants(self, action: GroundAction, price: Fraction) -> Iterator[tuple[Fraction, GroundAction]]:
        if not price:
            yield Fraction(0), action
            return
        for before, fact in self._facts.items():
            after = self._facts.get(before + price)
            if after is not None:
                pre, add = (*action.pre, fact), (*action.add, after)
                yield before, replace(action, pre=pre, add=add, delete=(*action.delete, fact))

    def plan(self, plan: HumanPlan) -> HumanPlan:
        """The human's plan, an action an epoch, by ids of this task."""
        found, amount = [], Fraction(0)
        for number in plan:
            price = self._prices[number]
            found.append(self._ids[number][amount if price else Fraction(0)])
            amount += price
        return tuple(found)

    def goal(self, goal: Condition, most: Fraction) -> Condition:
        """A goal with which they have paid no more than so much."""
        dearer = (fact for amount, fact in self._facts.items() if amount > most)
        return Condition(goal.positive, (*goal.negative, *dearer))

    def back(self, plan: Sequence[int]) -> tuple[int, ...]:
        """A plan by ids of the task that was given."""
        return tuple(self._original[number] for number in plan)

    def steps(self, steps: Iterable[Step]) -> tuple[Step, ...]:
        """Steps by these ids."""
        return tuple(Step(step.epoch, self._original[step.action]) for step in steps)


def _sums(costs: set[Fraction], most: Fraction, deadline: Deadline) -> list[Fraction]:
    """The amounts that costs may add up to, ascending."""
    found, new = {Fraction(0)}, {Fraction(0)}
    while new:
        new = {
            amount + cost for amount in deadline.each(new) for cost in costs if amount + cost <= most
        } - found
        found |= new
    return sorted(found)
