"""What is left of a scenario at least, from all states that robots can make beside the human's plan.

Where only windows of one epoch can pay (semantics 11), the kernel goes through these states epoch by epoch,
and back: one pass bounds what an ordinary call from each of them would tell.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Final

from search.call.context import SearchContext
from search.classical.problem import MOST_WEIGHT
from search.packed.cost_vector import ACTIONS_BITS
from search.packed.operators import Operator, union
from search.short_windows.joint.all_together import epochs_of
from search.short_windows.joint.epochs import Epochs
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

_MOST: Final = 600_000
"""States, and a quarter as many again each time that what is of interest is halved."""

_HALVES: Final = (0, 1, 2, 3, 4)
"""How often that is done where an epoch takes too long: fewer states are below a lower limit."""

_THERE: Final = 0.7
"""The share of the time for going there: going back takes less."""

_HUMP: Final = 2
"""An epoch may take so many times its share: those in the middle have the most states."""

_UNIT: Final = 1 << ACTIONS_BITS
"""The least that costs differ by: what is worth just the limit is worth knowing, or it is looked for."""


class Timetable:
    """The states beside one plan.

    Args:
        least: a key that is known to be no more than what the scenario is worth.
        limit: key from which on nothing is of interest; both are without the epoch of a window.

    Attributes:
        is_there: whether there is one: if there are too many states below the limit, below a lower one.
        is_whole: whether it has all states below the limit.
    """

    def __init__(
        self, context: SearchContext, steps: Sequence[Operator], least: int, limit: int, deadline: Deadline
    ) -> None:
        self._context, self._steps = context, steps
        self._epochs: Epochs | None = None
        amount_from = context.weights.amount_from
        limits = [amount_from(least + (limit - least >> n), MOST_WEIGHT) + _UNIT for n in _HALVES]
        self._limits = [*dict.fromkeys(limits)]
        with suppress(LimitReachedError):
            if steps and limits[0] < MOST_WEIGHT:
                self._epochs = self._passed(deadline)
        self.is_there = self._epochs is not None
        self.is_whole = self.is_there and self._limits[0] == limits[0]

    def _passed(self, deadline: Deadline) -> Epochs | None:
        """All states below the limit, gone through there and back; None where they are too many."""
        epochs, there = epochs_of(self._context, self._steps, deadline), deadline.part(_THERE)
        if epochs is None:
            return None
        mentioned, steps, runs = self._context.packed.mentioned, self._steps, [epochs.end_all]
        for epoch, step in enumerate(steps[:-1], start=1):
            runs += [partial(epochs.advance, step, union(map(mentioned, steps[epoch:-1]))), epochs.end_all]
        for number, run in enumerate(runs):
            if not self._over(run, there, min(1, _HUMP / (len(runs) - number))):
                return None
        epochs.go_back(self._limits[0], deadline)
        return epochs

    def _over(self, run: Callable[[int, int, Deadline], bool], there: Deadline, share: float) -> bool:
        """Whether a part of an epoch is over in its share of the time, under a lower limit if it must be."""
        while len(self._limits) > 1:
            with suppress(LimitReachedError):
                if run(self._limits[0], self._most, there.part(share)):
                    return True
            there.check()
            del self._limits[0]
        return run(self._limits[0], self._most, there)

    @property
    def _most(self) -> int:
        """States under the limit that is in force."""
        return _MOST * (len(_HALVES) - len(self._limits) + 4) // 4

    def least(self, epoch: int, state: int, *, at_once: bool = False) -> int:
        """Bound on the key of what is left after an epoch with a window of one to come, without that one.

        Args:
            at_once: if that is the next epoch.
        """
        if self._epochs is None or epoch >= len(self._steps):
            return 0
        amount = self._epochs.rest(epoch, state, at_once=at_once)
        return 0 if amount is None else self._context.weights.key_of(amount)
