"""What is left of a scenario at least, from all states that robots can make beside the human's plan.

Where only windows of one epoch can pay (semantics 11), the kernel goes through these states epoch by epoch,
and back: one pass bounds what an ordinary call from each of them would tell.
"""

from collections.abc import Sequence
from contextlib import suppress
from typing import Final

from search.call.context import SearchContext
from search.classical.problem import MOST_WEIGHT
from search.packed.operators import Operator, union
from search.short_windows.joint.all_together import epochs_of
from search.short_windows.joint.epochs import Epochs
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

_MOST: Final = 200_000
"""States."""

_HALVES: Final = (4, 1, 0)
"""How often what is of interest is halved: few states first, and more as long as there are not too many."""


class Timetable:
    """The states beside one plan.

    Args:
        least: a key that is known to be no more than what the scenario is worth.
        limit: key from which on nothing is of interest; both are without the epoch of a window.

    Attributes:
        is_there: whether there is one: if there are too many states below the limit, below a lower one.
    """

    def __init__(
        self, context: SearchContext, steps: Sequence[Operator], least: int, limit: int, deadline: Deadline
    ) -> None:
        self._context, self._steps = context, steps
        self._epochs: Epochs | None = None
        with suppress(LimitReachedError):
            for halves in _HALVES if steps else ():
                found = self._passed(least + (limit - least >> halves), deadline)
                if found is None:
                    break
                self._epochs = found
        self.is_there = self._epochs is not None

    def _passed(self, limit: int, deadline: Deadline) -> Epochs | None:
        """All states below a limit, gone through there and back; None where they are too many."""
        amount = self._context.amount_from(limit, MOST_WEIGHT)
        epochs = epochs_of(self._context, self._steps, deadline) if amount < MOST_WEIGHT else None
        if epochs is None:
            return None
        for epoch, step in enumerate((None, *self._steps[:-1])):
            later = union(map(self._context.packed.mentioned, self._steps[epoch:-1]))
            if step is not None and not epochs.advance(step, later, amount, _MOST, deadline):
                return None
            if epochs.leave(amount, _MOST, deadline) is None:
                return None
        epochs.go_back(amount, deadline)
        return epochs

    def least(self, epoch: int, state: int) -> int:
        """Bound on the key of what is left after an epoch with a window of one to come, without that one."""
        if self._epochs is None or epoch >= len(self._steps):
            return 0
        amount = self._epochs.rest(epoch, state)
        return 0 if amount is None else self._context.amount_key(amount)
