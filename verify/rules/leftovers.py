"""What a plan leaves changed, and that no plan costs less with that (semantics 12)."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction

from serendipity.model import Result
from serendipity.model.numbers import as_written, figure
from verify.base.execution import State

Prices = Mapping[int, tuple[bool, Fraction]]
"""By fact whether it is true without help, and what it costs if it is left otherwise."""


def left(prices: Prices, state: State) -> dict[int, Fraction]:
    """The priced facts that a last state has otherwise."""
    return {fact: price for fact, (true, price) in prices.items() if (fact in state) is not true}


def unpriced(result: Result, price: Fraction, alone: Fraction | None) -> Result:
    """A result as if what it leaves had cost nothing, which claims no more than that it can be had.

    Args:
        alone: what it costs without robots: then less may be an opportunity; None if not known.
    """
    cost = as_written(result.cost or 0)
    turned = not result.opportunity and alone is not None and cost - price < alone <= cost
    gained = as_written(result.human_cost or 0) - cost if turned else Fraction(0)

    def less(value: float | None, amount: Fraction) -> float | None:
        return None if value is None else figure(as_written(value) - amount)

    return replace(
        result,
        options=result.options.but(leave_price=None, leave_free=None),
        status="feasible",
        lower_bound=0.0,
        cost=less(result.cost, price),
        objective=less(result.objective, price),
        opportunity=result.opportunity or turned,
        saving=less(result.saving, -price - gained) if result.opportunity or turned else result.saving,
    )


class LeftoversCheck:
    """Refutes that anything costs less than an answer with what it leaves.

    Args:
        solve: the best plan that keeps some facts, and its last state; None undecided.
        prices: of all.
        weight: ``K`` where doing nothing fits a window of one epoch, else 0.
        idle: a cost from which on the best plan is no help, with what it leaves; None: whatever it costs.
    """

    def __init__(
        self,
        solve: Callable[[frozenset[int]], tuple[Result, State] | None],
        prices: Prices,
        weight: Fraction,
        idle: Fraction | None,
    ) -> None:
        self._solve, self._prices, self._weight, self._idle = solve, prices, weight, idle
        self._best: tuple[Fraction, Fraction] | None = None

    def none_below(self, total: Fraction) -> bool | None:
        """Whether no plan that helps has a smaller total; None if undecided."""
        if not self._look(total, frozenset(), frozenset()):
            return None
        return self._best is None or (self._idle is not None and self._best[1] >= self._idle)

    def _look(self, total: Fraction, kept: frozenset[int], paid: frozenset[int]) -> bool:
        """Whether the best plan below a total that keeps and leaves some facts is found, if there is one."""
        solved = self._solve(kept)
        if solved is None:
            return False
        found, state = solved
        if found.objective is None:
            return True
        least = as_written(found.objective) + (self._weight if found.window is None else 0)
        if least + self._sum(paid) >= (total if self._best is None else self._best[0]):
            return True
        leaves = frozenset(left(self._prices, state))
        whole = least + self._sum(leaves), as_written(found.cost or 0) + self._sum(leaves)
        if whole[0] < total:
            self._best = whole if self._best is None else min(self._best, whole)
        for fact in sorted(leaves - paid):
            if not self._look(total, kept | {fact}, paid):
                return False
            paid |= {fact}
        return True

    def _sum(self, facts: frozenset[int]) -> Fraction:
        return sum((self._prices[fact][1] for fact in facts), Fraction(0))
