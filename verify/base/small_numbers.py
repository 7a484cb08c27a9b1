"""Smaller numbers for the same question: all plans that its horizon allows keep their order.

A task with costs such as 1.000000001, or with a discount of many decimals, has few different prices, but a
unit so small that sums of them fit neither into a solver's tolerances nor into machine words.  Of such
prices only the order of sums matters, and sums have few terms.  So they are taken apart: with a step ``S``
each is ``a S + r``, the rest ``r`` so small that all rests of two plans together do not make up one step.
Then of two sums the one with fewer steps is less, and of equal ones the one with the lesser rest: ``a B + r``
has the same order for any base ``B`` that all these rests together do not reach.  Rests are prices of the
same kind, so they get smaller in the same way first.

What a plan may cost is mapped likewise: to the largest small number that no plan within the limit passes.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from verify.base.subproblem import IntegerPrices, Subproblem, least
from verify.limits import limits

_STEPS: Final = 50_000
"""Steps at most that the largest number is tried to be."""


@dataclass(frozen=True, slots=True)
class OrderOfSums:
    """Numbers for numbers, such that sums of few of them, signs included, have the same order.

    Attributes:
        step: ``S``; 0: numbers are their own.
        base: ``B``.
        reach: no sum of rests of one of the two is larger.
        rests: the same for rests; None where the step is 0.
    """

    step: int = 0
    base: int = 1
    reach: int = 0
    rests: "OrderOfSums | None" = None

    @classmethod
    @lru_cache(maxsize=64)  # each costs up to a tenth of a second
    def of(cls, numbers: frozenset[int], terms: int) -> "OrderOfSums":
        """The order of sums of so many terms at most.

        Args:
            numbers: those that are added up.
            terms: of two sums together; an even number.
        """
        each = sorted({number for number in numbers if number}, key=abs, reverse=True)
        largest = abs(each[0]) if each else 0
        for count in range(1, min(_STEPS, largest // (terms + 1)) + 1):
            step = _nearest(largest, count)
            if all(terms * abs(_rest(number, step)) < step for number in each):
                rests = {_rest(number, step) for number in each}
                inner = cls.of(frozenset(rests), terms)
                base = terms * max(abs(inner(rest)) for rest in rests) + 1
                found = cls(step, base, terms // 2 * max(map(abs, rests)), inner)
                return found if max(abs(found(number)) for number in each) < largest else cls()
        return cls()

    def __call__(self, number: int) -> int:
        """The number for a price or a sum of prices."""
        if self.rests is None:
            return number
        return _nearest(number, self.step) * self.base + self.rests(_rest(number, self.step))

    def limit(self, most: int) -> int:
        """The number that a sum's is at most exactly if the sum is at most ``most``."""
        if self.rests is None:
            return most
        rest, half = self.rests.limit(_rest(most, self.step)), self.base // 2
        return _nearest(most, self.step) * self.base + max(-half - 1, min(rest, half))

    def bound(self, number: int) -> int:
        """No sum is less whose number is at least this one; the sum itself where there is one."""
        if self.rests is None:
            return number
        rest = self.rests.bound(_rest(number, self.base))
        return _nearest(number, self.base) * self.step + max(-self.reach, min(rest, self.reach))


def _nearest(number: int, step: int) -> int:
    """How often a step goes into a number, rounded to the nearest."""
    return (2 * number + step) // (2 * step)


def _rest(number: int, step: int) -> int:
    """What is left of a number then, or missing."""
    return number - _nearest(number, step) * step


def with_small_numbers(question: Subproblem) -> tuple[Subproblem, OrderOfSums]:
    """The question with smaller numbers where they are too large for solvers, and what became of them.

    What passes a limit by itself just passes it then.
    """
    prices, most, most_cost = question.prices, question.most, question.most_cost
    if question.horizon * question.an_epoch <= limits().coefficient:
        return question, OrderOfSums()
    team, talk = _within(prices.team, least(most, most_cost)), _within(prices.talk, most)
    (epoch,) = _within((prices.epoch,), most)
    an_epoch = len(question.task.agents) + any(talk) + (epoch > 0)  # only the human talks
    order = OrderOfSums.of(frozenset((*team, *talk, epoch)), 2 * question.horizon * an_epoch)
    small = IntegerPrices(0, tuple(map(order, team)), tuple(map(order, talk)), order(epoch))
    found = question.but(prices=small, most=None)  # no plan has more than the largest
    given = (None if each is None else min(order.limit(each), found.largest) for each in (most, most_cost))
    most, most_cost = given
    return found.but(most=most, most_cost=most_cost), order


def _within(prices: tuple[int, ...], most: int | None) -> tuple[int, ...]:
    return prices if most is None else tuple(min(price, max(most, 0) + 1) for price in prices)
