"""The price of what help leaves changed (semantics 12), by branch and bound over what has to be kept.

A call with prices is first one without, whose answer leaves something.  Each of these facts is kept, in a
call with one more goal of the robots', or paid for; those before it in the row are paid for then.
"""

import heapq
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from typing import Final, NamedTuple

from serendipity.facade.call import Request
from serendipity.facade.kept import Kept, Literal, left
from serendipity.model import Step, Task
from serendipity.model.answers.answer import Answer
from serendipity.model.options import Options

Keep = Callable[[frozenset[Literal]], Iterator[Answer]]
"""Answers to the call without prices, with some priced literals kept."""

_NOTHING: Final[frozenset[Literal]] = frozenset()


class _Call(NamedTuple):
    """A call without prices that is to be answered; ordered by its bound.

    Attributes:
        bound: no plan that keeps and pays so much has a smaller total.
        number: which one it is.
        kept: what has to be kept.
        paid: what is left, whatever else is.
    """

    bound: Fraction
    number: int
    kept: frozenset[Literal]
    paid: frozenset[Literal]


class _Prices:
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


def priced(call: Request, rule: Kept, keep: Keep) -> Iterator[Answer]:
    """Answers with what they leave among their costs, as they get better.

    Args:
        call: the call.
        rule: what has to be kept, and what costs something.
        keep: answers it without prices.
    """
    calls, number = [_Call(Fraction(0), 0, _NOTHING, _NOTHING)], 0
    best: Answer | None = None
    alone: Fraction | None = None  # known where nothing is kept, which would be a goal of the robots'
    prices = _Prices(call.task, rule)
    while calls and (best is None or calls[0].bound <= _total(call.options, best)):
        bound, _, kept, paid = heapq.heappop(calls)
        *_, found = keep(kept)
        alone = found.saving_alone if not kept else alone
        found = found._replace(saving_alone=alone)
        if found.cost is not None:
            candidate = _with_price(call, rule, found)
            if best is None or _order(call.options, candidate) < _order(call.options, best):
                best = candidate
        if found.status not in ("optimal", "infeasible"):
            yield _unproved(call.options, best or found, bound)
            return
        if found.status == "infeasible":
            if best is None and not calls:
                yield found
            continue
        for literal in prices.open(left(call, rule, found), kept, paid):
            number += 1
            more = kept | {literal}
            least = _total(call.options, found) + prices.least(more, paid)
            heapq.heappush(calls, _Call(max(bound, least), number, more, paid))
            paid |= {literal}
        if best is not None and calls:
            yield _unproved(call.options, best, calls[0].bound)
    if best is not None:
        yield _settled(best)


def _with_price(call: Request, rule: Kept, answer: Answer) -> Answer:
    """An answer whose costs include what it leaves."""
    found = left(call, rule, answer)
    price = sum((price for _, price in found), Fraction(0))
    return answer._replace(
        cost=(answer.cost or 0) + price,
        objective=(answer.objective or 0) + price,
        saving=None if answer.saving is None else answer.saving - price,
        left=tuple((fact, price) for (fact, _), price in found),
    )


def _total(options: Options, answer: Answer) -> Fraction:
    """The objective, of doing nothing with the shortest window that it fits (semantics 3.1)."""
    least = answer.objective or Fraction(0)
    return least + options.window_weight if options.windowed and answer.window is None else least


def _order(options: Options, answer: Answer) -> tuple[Fraction, Fraction]:
    return _total(options, answer), answer.cost or Fraction(0)


def _settled(answer: Answer) -> Answer:
    """The best answer, proved: doing nothing where it is no opportunity."""
    least = None if answer.baseline is None else answer.baseline - (answer.saving_alone or 0)
    if answer.window is not None and least is not None and (answer.cost or 0) >= least:
        steps = tuple(Step(epoch, action) for epoch, action in enumerate(answer.human_plan or (), start=1))
        nothing = answer._replace(steps=steps, window=None, left=(), saving=Fraction(0), opportunity=False)
        answer = nothing._replace(cost=answer.baseline, objective=answer.baseline)
    helps = answer.opportunity and (least is None or (answer.cost or 0) < least)
    return answer._replace(status="optimal", lower_bound=answer.objective, opportunity=helps)


def _unproved(options: Options, answer: Answer, bound: Fraction) -> Answer:
    """An answer on the way, or at a limit."""
    if answer.cost is None:
        return answer
    least = max(Fraction(0), bound - options.window_weight) if options.windowed else bound
    nothing = _settled(answer)
    return nothing._replace(status="feasible", lower_bound=min(least, nothing.objective or least))
