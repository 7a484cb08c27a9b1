"""Rules for the prime's choice among optimal actions: the worst of them, their mean, the best, the first."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from search.modes.assistance.game.game import Game, Move
from search.modes.assistance.game.solution import Costs
from search.packed.cost_vector import INFINITE_KEY

Value = Any
"""An ``int`` of the game (robust), or a pair of exact costs (expected); ordered by ``<``."""


class Worst:
    """Robust: the lexicographically greatest."""

    infinite: Value = INFINITE_KEY

    def lift(self, value: int) -> Value:
        """A value of the game in the rule's form."""
        return value

    def add(self, value: int, rest: Value) -> Value:
        """A move's value and what follows it."""
        return min(value + rest, INFINITE_KEY)

    def combine(self, values: Sequence[Value]) -> Value:
        """The value of a state in which the prime chooses."""
        return max(values)

    def costs(self, game: Game, value: Value) -> Costs | None:
        """The costs in a value; None if infinite."""
        return None if value >= INFINITE_KEY else game.pair(value)

    def counted(self, moves: tuple[Move, ...]) -> tuple[Move, ...]:
        """Those of the prime's optimal actions that count."""
        return moves


class Best(Worst):
    """Optimistic: the lexicographically least, as if we chose for the prime."""

    def combine(self, values: Sequence[Value]) -> Value:
        """See :class:`Worst`."""
        return min(values)


class First(Worst):
    """Fixed: the one of the smallest name."""

    def counted(self, moves: tuple[Move, ...]) -> tuple[Move, ...]:
        """See :class:`Worst`."""
        return moves[:1]


class Mean:
    """Expected: the mean of each cost, all actions alike likely."""

    infinite: Value = (INFINITE_KEY, INFINITE_KEY)

    def __init__(self, game: Game) -> None:
        self._unit = 1 << game.unit_bits

    def lift(self, value: int) -> Value:
        """See :class:`Worst`."""
        return self.infinite if value >= INFINITE_KEY else divmod(value, self._unit)

    def add(self, value: int, rest: Value) -> Value:
        """See :class:`Worst`."""
        if rest == self.infinite:
            return rest
        prime, supporter = divmod(value, self._unit)
        return (prime + rest[0], supporter + rest[1])

    def combine(self, values: Sequence[Value]) -> Value:
        """See :class:`Worst`."""
        if len(values) == 1:
            return values[0]
        if any(value == self.infinite for value in values):
            return self.infinite
        return (
            Fraction(sum(value[0] for value in values), len(values)),
            Fraction(sum(value[1] for value in values), len(values)),
        )

    def costs(self, game: Game, value: Value) -> Costs | None:
        """See :class:`Worst`."""
        if value == self.infinite:
            return None
        return Fraction(value[0]) / game.scale, Fraction(value[1]) / game.scale

    def counted(self, moves: tuple[Move, ...]) -> tuple[Move, ...]:
        """See :class:`Worst`."""
        return moves


ChoiceRule = Worst | Mean
"""How the prime's optimal actions count."""
