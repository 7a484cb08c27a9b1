"""The price of what help leaves changed (semantics 12), by branch and bound over what has to be kept.

A call with prices is first one without, whose answer leaves something.  Each of these facts is kept, in a
call with one more goal of the robots', or paid for; those before it in the row are paid for then.
"""

import heapq
from collections.abc import Callable, Hashable, Iterable, Iterator
from fractions import Fraction
from typing import Generic, NamedTuple, Protocol, TypeVar

from serendipity.facade.call import Request
from serendipity.facade.kept import Kept, Literal, left
from serendipity.model import Step, Task
from serendipity.model.answers.answer import Answer
from serendipity.model.options import Options

L = TypeVar("L", bound=Hashable)
"""A priced literal, by what it is kept for."""

Keep = Callable[[frozenset[L], frozenset[L]], Iterator[Answer]]
"""Answers to the call without prices, with some priced literals kept, and some paid for in any case."""


class PricedQuestion(Protocol[L]):
    """A call whose answers pay for what they leave.

    Attributes:
        adds_up: whether prices add to everything else, so that the best plan without them is the best of
            those that leave no more than it does.
    """

    adds_up: bool

    def least(self, kept: frozenset[L], paid: frozenset[L]) -> Fraction:
        """What is to be paid if some literals are kept, and some left."""

    def open(self, found: Answer, kept: frozenset[L], paid: frozenset[L]) -> list[L]:
        """What an answer leaves that is not settled."""

    def with_price(self, answer: Answer) -> Answer:
        """An answer whose costs include what it leaves."""

    def total(self, answer: Answer) -> Fraction:
        """What is minimised."""

    def settled(self, answer: Answer) -> Answer:
        """The best answer, proved: doing nothing where it is no opportunity."""


class _OpenCall(NamedTuple, Generic[L]):
    """A call without prices that is to be answered; ordered by its bound.

    Attributes:
        bound: no plan that keeps and pays so much has a smaller total.
        number: which one it is.
        kept: what has to be kept.
        paid: what is left, whatever else is.
    """

    bound: Fraction
    number: int
    kept: frozenset[L]
    paid: frozenset[L]


class LeftoverPrices:
    """What has to be paid at least for what is left.

    Who is no more where they would be is somewhere else: of a group of facts of which exactly one is true the
    cheapest other one is paid for, too.
    """

    def __init__(self, task: Task, rule: Kept) -> None:
        self._prices = dict(rule.prices)
        self._others: dict[Literal, list[Literal]] = {}
        for group in task.variables:
            for fact in group.facts:
                if (fact, True) in self._prices:
                    others = set(group.facts) - {fact} - set(rule.facts.negative)
                    self._others[fact, True] = [(one, False) for one in sorted(others)]

    def least(self, kept: frozenset[Literal], paid: frozenset[Literal]) -> Fraction:
        """What is to be paid if some literals are kept, and some left."""
        found = sum((self._prices[literal] for literal in paid), Fraction(0))
        for literal in paid & self._others.keys():
            if paid.isdisjoint(self._others[literal]):
                found += self._cheapest(literal, kept)
        return found

    def open(
        self, found: Iterable[tuple[Literal, Fraction]], kept: frozenset[Literal], paid: frozenset[Literal]
    ) -> list[Literal]:
        """What an answer leaves that is not settled: where somebody would be first, then the dearest."""
        settled = {
            (fact, self._cheapest(literal, kept))
            for literal in paid & self._others.keys()
            for fact in self._others[literal]
        }
        literals = [one for one, price in found if one not in paid and (one, price) not in settled]
        return sorted(literals, key=lambda one: one not in self._others)

    def _cheapest(self, literal: Literal, kept: frozenset[Literal]) -> Fraction:
        others = (one for one in self._others[literal] if one not in kept)
        return min((self._prices.get(one, Fraction(0)) for one in others), default=Fraction(0))


class OnePlan:
    """A call beside one plan of the human's, whose answers pay for what they leave."""

    adds_up = True

    def __init__(self, call: Request, rule: Kept) -> None:
        self._call, self._rule, self._prices = call, rule, LeftoverPrices(call.task, rule)
        self._options = call.options

    def least(self, kept: frozenset[Literal], paid: frozenset[Literal]) -> Fraction:
        """What is to be paid if some literals are kept, and some left."""
        return self._prices.least(kept, paid)

    def open(self, found: Answer, kept: frozenset[Literal], paid: frozenset[Literal]) -> list[Literal]:
        """What an answer leaves that is not settled."""
        return self._prices.open(left(self._call, self._rule, found), kept, paid)

    def with_price(self, answer: Answer) -> Answer:
        """An answer whose costs include what it leaves."""
        found = left(self._call, self._rule, answer)
        return paying(answer, [(fact, price) for (fact, _), price in found])

    def total(self, answer: Answer) -> Fraction:
        """The objective, of doing nothing with the shortest window that it fits (semantics 3.1)."""
        least = answer.objective or Fraction(0)
        weight = self._options.window_weight if self._options.windowed else Fraction(0)
        return least + weight if answer.window is None else least

    def settled(self, answer: Answer) -> Answer:
        """The best answer, proved: doing nothing where it is no opportunity."""
        return beating_alone(answer)._replace(status="optimal", lower_bound=answer.objective)


def beating_alone(answer: Answer) -> Answer:
    """The answer, or doing nothing where it is no opportunity: they do as well alone, or may do so."""
    least = None if answer.baseline is None else answer.baseline - (answer.saving_alone or 0)
    if answer.opportunity and (least is None or (answer.cost or 0) < least):
        return answer
    saving = answer.saving if least is None else Fraction(0)
    nothing = answer._replace(opportunity=False, saving=saving)
    if answer.window is None or least is None:
        return nothing
    steps = tuple(Step(epoch, action) for epoch, action in enumerate(answer.human_plan or (), start=1))
    nothing = nothing._replace(steps=steps, window=None, left=())
    return nothing._replace(cost=answer.baseline, objective=answer.baseline)


def paying(answer: Answer, found: Iterable[tuple[int, Fraction]]) -> Answer:
    """An answer with what it leaves, and the prices of that among its costs."""
    listed = tuple(found)
    price = sum((price for _, price in listed), Fraction(0))
    return answer._replace(
        cost=(answer.cost or 0) + price,
        objective=(answer.objective or 0) + price,
        saving=None if answer.saving is None else answer.saving - price,
        left=listed,
    )


def priced(options: Options, question: PricedQuestion[L], keep: Keep[L]) -> Iterator[Answer]:
    """Answers with what they leave among their costs, as they get better.

    Args:
        options: of the call.
        question: what answers leave, and what that costs.
        keep: answers it without prices.
    """
    nothing = frozenset[L]()
    calls, number = [_OpenCall(Fraction(0), 0, nothing, nothing)], 0
    best: Answer | None = None
    alone: Fraction | None = None  # known where nothing is kept, which would be a goal of the robots'
    while calls and (best is None or calls[0].bound <= question.total(best)):
        bound, _, kept, paid = heapq.heappop(calls)
        *_, found = keep(kept, paid)
        alone = found.saving_alone if not kept and not paid else alone
        found = found._replace(saving_alone=alone)
        if found.cost is not None:
            candidate = question.with_price(found)
            if best is None or _order(question, candidate) < _order(question, best):
                best = candidate
        if found.status not in ("optimal", "infeasible"):
            yield _unproved(options, question, best or found, bound)
            return
        if found.status == "infeasible":
            if best is None and not calls:
                yield found
            continue
        unsettled = question.open(found, kept, paid)
        if unsettled and not question.adds_up:
            number += 1
            heapq.heappush(calls, _OpenCall(question.total(found), number, kept, paid.union(unsettled)))
        for literal in unsettled:
            number += 1
            more = kept | {literal}
            least = question.total(found) + question.least(more, paid)
            heapq.heappush(calls, _OpenCall(max(bound, least), number, more, paid))
            paid |= {literal}
        if best is not None and calls:
            yield _unproved(options, question, best, calls[0].bound)
    if best is not None:
        yield question.settled(best)


def _order(question: PricedQuestion[L], answer: Answer) -> tuple[Fraction, Fraction]:
    return question.total(answer), answer.cost or Fraction(0)


def _unproved(options: Options, question: PricedQuestion[L], answer: Answer, bound: Fraction) -> Answer:
    """An answer on the way, or at a limit."""
    if answer.cost is None:
        return answer
    least = max(Fraction(0), bound - options.window_weight) if options.windowed else bound
    nothing = question.settled(answer)
    return nothing._replace(status="feasible", lower_bound=min(least, nothing.objective or least))
