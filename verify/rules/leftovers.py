"""What a plan leaves changed, and that no plan costs less with that (semantics 12)."""

from collections.abc import Callable, Mapping
from fractions import Fraction

from serendipity.model import Result
from serendipity.model.numbers import as_written
from verify.base.execution import State

Prices = Mapping[int, tuple[bool, Fraction]]
"""By fact whether it is true without help, and what it costs if it is left otherwise."""


def left(prices: Prices, state: State) -> dict[int, Fraction]:
    """The priced facts that a last state has otherwise."""
    return {fact: price for fact, (true, price) in prices.items() if (fact in state) is not true}


class Leftovers:
    """Refutes that anything costs less than an answer with what it leaves.

    Args:
        solve: the best plan that keeps some facts, and its last state; None undecided.
        prices: of all.
        weight: ``K`` where doing nothing fits a window of one epoch, else 0.
    """

    def __init__(
        self, solve: Callable[[frozenset[int]], tuple[Result, State] | None], prices: Prices, weight: Fraction
    ) -> None:
        self._solve, self._prices, self._weight = solve, prices, weight

    def none_below(
        self, total: Fraction, kept: frozenset[int] = frozenset(), paid: frozenset[int] = frozenset()
    ) -> bool | None:
        """Whether no plan that keeps and leaves some facts has a smaller total; None if undecided."""
        solved = self._solve(kept)
        if solved is None:
            return None
        found, state = solved
        if found.objective is None:
            return True
        least = as_written(found.objective) + (self._weight if found.window is None else 0)
        if least + self._sum(paid) >= total:
            return True
        leaves = frozenset(left(self._prices, state))
        if least + self._sum(leaves) < total:
            return False
        for fact in sorted(leaves - paid):
            verdict = self.none_below(total, kept | {fact}, paid)
            if not verdict:
                return verdict
            paid |= {fact}
        return True

    def _sum(self, facts: frozenset[int]) -> Fraction:
        return sum((self._prices[fact][1] for fact in facts), Fraction(0))
