"""Rules for the prime's choice among optimal actions: the worst of them, their mean, the best, the first."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from search.modes.assistance.game.game import Game, Move
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model.answers.policy import Costs

Value = Any
"""An ``int`` of the game (robust), or a pair of exact costs (expected); ordered by ``<``."""


class ChoiceRule:
    """How the prime's optimal actions count: the lexicographically greatest, or least, or the first one.

    Attributes:
        is_ours: optimistic: as if we chose for the prime.
    """

    infinite: Value = INFINITE_KEY

    def __init__(self, game: Game, ties: str) -> None:
        self._game = game
        self.is_ours = ties == "optimistic"
        self._is_first = ties == "fixed"

    def lift(self, value: int) -> Value:
        """A value of the game in the rule's form."""
        return value

    def add(self, value: int, rest: Value) -> Value:
        """A move's value and what follows it."""
        return min(value + rest, INFINITE_KEY)

    def combine(self, values: Sequence[Value]) -> Value:
        """The value of a state in which the prime chooses."""
        return min(values) if self.is_ours else max(values)

    def costs(self, value: Value) -> Costs | None:
        """The costs in a value; None if infinite."""
        return None if value >= INFINITE_KEY else self._game.pair(value)

    def counted(self, moves: tuple[Move, ...]) -> tuple[Move, ...]:
        """Those of the prime's optimal actions that count: all, or the one of the smallest name."""
        return moves[:1] if self._is_first else moves


class Mean(ChoiceRule):
    """Expected: the mean of each cost, all actions alike likely."""

    infinite: Value = (INFINITE_KEY, INFINITE_KEY)

    def lift(self, value: int) -> Value:
        """See :class:`ChoiceRule`."""
        return self.infinite if value >= INFINITE_KEY else divmod(value, 1 << self._game.unit_bits)

    def add(self, value: int, rest: Value) -> Value:
        """See :class:`ChoiceRule`."""
        if rest == self.infinite:
            return rest
        prime, supporter = divmod(value, 1 << self._game.unit_bits)
        return (prime + rest[0], supporter + rest[1])

    def combine(self, values: Sequence[Value]) -> Value:
        """See :class:`ChoiceRule`."""
        if len(values) == 1:
            return values[0]
        if any(value == self.infinite for value in values):
            return self.infinite
        return tuple(Fraction(sum(costs), len(values)) for costs in zip(*values, strict=True))

    def costs(self, value: Value) -> Costs | None:
        """See :class:`ChoiceRule`."""
        if value == self.infinite:
            return None
        return Fraction(value[0]) / self._game.scale, Fraction(value[1]) / self._game.scale
