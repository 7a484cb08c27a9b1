"""Windows of one epoch: which of what robots can leave behind by then may still be worth it."""

from collections.abc import Collection
from typing import Final

from search.short_windows.independent.landmarks import Landmarks
from search.short_windows.independent.provision import Value
from search.short_windows.independent.remaining import Remaining
from search.call.context import SearchContext
from search.packed.cost_vector import ACTIONS_BITS, FAR, INFINITE_KEY
from search.packed.operators import Operator

ACTION: Final = 1 << ACTIONS_BITS
"""Amounts are costs in these units, and a number of actions."""

FEW: Final = 50
"""So many outcomes are told one by one sooner than by landmarks."""


class Window:
    """What robots can have left behind by the end of a window of one epoch, in which the human waits.

    Args:
        context: of the call.
        landmarks: of the human's own task.
        base: the packed state before it without robots.
        start: key of what comes before it, and of the window.

    Attributes:
        found: the least key of what was looked at.
    """

    is_exact = True
    """Whether robots can do what is looked at."""

    def __init__(self, context: SearchContext, landmarks: Landmarks, base: int, start: int) -> None:
        self.found = INFINITE_KEY
        self._context = context
        self._landmarks = landmarks
        self._base = base
        self._start = start
        self._given: Collection[Value] = ()
        """The values that fields can have."""
        self._remaining: Remaining | None = None
        self._least = 0
        """The amount that nothing is below, where there are too many outcomes."""

    def _most(self, limit: int) -> int:
        """The amount from which on nothing is of interest, by a limit on keys."""
        return self._context.amount_from(limit - self._start, FAR)

    @property
    def bound(self) -> int:
        """No plan with this window has a smaller key, but for what was too dear when it was asked for."""
        least = self._least
        if self._remaining is not None:
            if not len(self._remaining):
                return self.found
            least = self._remaining.least
        return min(self.found, self._start + self._context.amount_key(least))

    def is_open(self, limit: int) -> bool:
        """Whether something is left that may be below a limit."""
        if self._remaining is None or (self.found < limit and not self.is_exact):
            return False
        self._remaining.drop(self._most(limit))
        return len(self._remaining) > 0

    def look(self, limit: int) -> int | None:
        """Look at an outcome: its place if it is below a limit.

        Raises:
            LimitReachedError: the deadline came.
        """
        context, alone = self._context, self._context.alone
        assert self._remaining is not None, "it is open"
        context.deadline.check()
        place, state, amount = self._remaining.take()
        paid = self._start + context.amount_key(amount)
        if paid + alone.least(state) < limit:
            key = paid + alone.key(state, limit - paid)
            if key < limit:
                self.found = min(self.found, key)
                return place if self.is_exact else None
        if len(self._remaining) > FEW:
            self._remaining.learn(self._landmarks.of(state, self._given))
        return None

    def ways(self, place: int) -> list[list[Operator]] | None:
        """What robots do epoch by epoch for something that they leave behind; None where no way is found.

        Raises:
            LimitReachedError: the deadline came.
        """
        raise NotImplementedError
