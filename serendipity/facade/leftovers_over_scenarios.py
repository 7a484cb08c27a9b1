"""The price of what help leaves changed in each of several scenarios, in the mean (semantics 11, 12)."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from search.modes.scenarios import Candidate
from serendipity.facade.kept import Kept, Literal, left_by
from serendipity.facade.leftovers import Prices, paying
from serendipity.model import Options, Task
from serendipity.model.answers.answer import Answer, ServedGoal

Literals = frozenset[tuple[int, Literal]]
"""Priced literals, each of the scenario of a number."""


class OverScenarios:
    """A call over scenarios whose answers pay for what they leave; ``idle`` is the answer of idle robots."""

    def __init__(
        self,
        task: Task,
        options: Options,
        candidates: Sequence[Candidate],
        rules: Sequence[Kept],
        last: int,
        idle: Answer,
    ) -> None:
        self._task, self._options, self._last, self._idle = task, options, last, idle
        self._rules, self._shares = rules, [one.weight for one in candidates]
        self._prices = [Prices(task, rule) for rule in rules]

    def least(self, kept: Literals, paid: Literals) -> Fraction:
        """See :class:`.Question`."""
        each = enumerate(zip(self._shares, self._prices, strict=True))
        found = (share * prices.least(_of(k, kept), _of(k, paid)) for k, (share, prices) in each)
        return sum(found, Fraction(0))

    def open(self, found: Answer, kept: Literals, paid: Literals) -> list[tuple[int, Literal]]:
        """See :class:`.Question`."""
        return [
            (k, literal)
            for k, (goal, prices) in enumerate(zip(found.goals or (), self._prices, strict=True))
            for literal in prices.open(self._left(k, goal), _of(k, kept), _of(k, paid))
        ]

    def with_price(self, answer: Answer) -> Answer:
        """See :class:`.Question`; what is left counts by how likely that is."""
        goals, listed = [], dict[int, Fraction]()
        for k, goal in enumerate(answer.goals or ()):
            found = self._left(k, goal)
            price = sum((price for _, price in found), Fraction(0))
            goals.append(replace(goal, cost=(goal.cost or Fraction(0)) + price))
            for (fact, _), price in found:
                listed[fact] = listed.get(fact, Fraction(0)) + price * self._shares[k]
        return paying(answer._replace(goals=tuple(goals)), listed.items())

    def total(self, answer: Answer) -> Fraction:
        """See :class:`.Question`; idle robots leave the human alone, which counts as an epoch of window."""
        least = answer.objective or Fraction(0)
        if answer.opportunity:
            return least
        return least - (answer.saving_alone or Fraction(0)) + self._options.window_weight

    def settled(self, answer: Answer) -> Answer:
        """See :class:`.Question`."""
        least = (answer.baseline or Fraction(0)) - (answer.saving_alone or 0)
        if answer.cost is not None and answer.cost >= least:
            idle = self._idle
            answer = answer._replace(
                steps=idle.steps, goals=idle.goals, cost=idle.cost, objective=idle.objective, left=()
            )
            answer = answer._replace(opportunity=False, saving=Fraction(0))
        return answer._replace(status="optimal", lower_bound=answer.objective)

    def _left(self, k: int, goal: ServedGoal) -> list[tuple[Literal, Fraction]]:
        return left_by(self._task, self._rules[k], goal.steps or (), self._last)


def _of(number: int, literals: Literals) -> frozenset[Literal]:
    return frozenset(literal for k, literal in literals if k == number)
