"""The bound while the human follows ``pi_H``, by when the window opens (see :mod:`.first_interaction`)."""

from collections.abc import Iterator, Sequence
from itertools import accumulate
from typing import Final, NamedTuple

from search.bounds.achievers import Provided, soonest
from search.packed.cost_vector import INFINITE_KEY
from search.packed.joint_actions import Idle
from search.packed.table import StateCache

_MOST_KEPT: Final = 1_000_000
"""Offers in the lists that are kept: some 10 MiB."""


class PrefixBounds:
    """The human's totals while they follow ``pi_H``, by need and by the epoch before the window.

    Args:
        epochs: length of ``pi_H``.
        reach: epochs that a window that still pays can have.

    Attributes:
        without: least total without a touch, if the window opens after an epoch or later.
        floor: least total at all, if it opens after an epoch or later.
        least: least total by need.
        now: total by need, if it opens right after an epoch; for needs that were refined.
        later: the same, if it opens then or later.
        latest: last epoch in which robots can provide a need.
    """

    def __init__(self, epochs: int, reach: int, floor: Sequence[int]) -> None:
        self.reach = reach
        self.without = [INFINITE_KEY] * epochs
        self.floor = list(accumulate(reversed(floor), min))[::-1]
        self.least: dict[int, int] = {}
        self.now: dict[int, list[int]] = {}
        self.later: dict[int, list[int]] = {}
        self.latest: dict[int, int] = {}
        self._until: dict[int, int] = {}

    def add(self, end: int, without: int, totals: dict[int, int]) -> None:
        """Least totals if the window opens before epoch ``end`` is over."""
        self.without[:end] = [min(known, without) for known in self.without[:end]]
        for need, total in totals.items():
            self.least[need] = min(total, self.least.get(need, total))
            self._until[need] = end

    def refine(self, need: int, first: int, totals: Sequence[int]) -> None:
        """Totals of a need from the epoch ``first`` on, one by one."""
        now = self.now.setdefault(need, [INFINITE_KEY] * len(self.without))
        now[first : first + len(totals)] = totals
        self.later[need] = list(accumulate(reversed(now), min))[::-1]

    def rough(self, need: int, cost: int, steps: int) -> int:
        """Least total of a need that was not refined (see :meth:`total`)."""
        if steps - self.reach >= self._until[need] or steps > self.latest[need]:
            return INFINITE_KEY
        return self.least[need] + cost

    def total(self, need: int, cost: int, steps: int, epoch: int = 0) -> int:
        """Least total if robots need a cost and some epochs from ``epoch`` on to provide."""
        row = self.later[need]
        opens = max(epoch, epoch + steps - self.reach)
        if opens >= len(row) or epoch + steps > self.latest[need]:
            return INFINITE_KEY
        return row[opens] + cost

    def least_after(self, steps: int) -> int:
        """Least total at all, if robots need some epochs to provide what the human touches."""
        opens = max(0, steps - self.reach)
        return self.floor[opens] if opens < len(self.floor) else INFINITE_KEY


class Offer(NamedTuple):
    """The least total of a plan in which robots provide a need from where they are.

    Attributes:
        least: least total of the human, and ``cost``.
        cost: what they pay.
        epochs: in how many epochs, per robot that may act first.
        need: the need.
    """

    least: int
    cost: int
    epochs: tuple[int, ...]
    need: int


class FirstInteractionOnTheWay:
    """The bound while the human follows ``pi_H``; a window has still to open.

    Args:
        openings: their totals.
        spent: what following ``pi_H`` has cost by each epoch.
        needs: the surviving needs; None where robots may provide them for nothing.
        outside: the fields on which their costs depend.
    """

    def __init__(
        self, openings: PrefixBounds, spent: Sequence[int], needs: dict[int, Provided | None], outside: int
    ) -> None:
        self._openings = openings
        self._spent = spent
        self._needs = needs
        self._outside = outside
        self._offers: StateCache[list[Offer]] = StateCache(_MOST_KEPT)
        self._known: dict[Offer, Offer] = {}  # of equal ones, lists hold the same
        self._too_dear = max(openings.without, default=0)
        for need in needs:
            if need not in openings.later:
                openings.refine(need, 0, [openings.least[need]] * len(spent))

    def opening(self, epoch: int, state: int, idle: Idle = ()) -> int:
        """Least key increment if the window opens right after ``epoch``."""
        return self.opening_after(epoch, epoch, state, epoch + self._openings.reach, idle)

    def opening_after(self, opens: int, epoch: int, state: int, until: int, idle: Idle = ()) -> int:
        """Least key increment from a packed state after ``epoch``.

        The window opens right after the epoch ``opens``, and robots act up to ``until``.
        """
        openings = self._openings
        least = openings.without[opens]
        for offer in self._from(state):
            if offer.least >= least:
                break
            total, latest = openings.now[offer.need][opens] + offer.cost, openings.latest[offer.need]
            if total < least and epoch + soonest(offer.epochs, idle) <= min(latest, until):
                least = total
        return least - self._spent[epoch]

    def later(self, epoch: int, state: int, idle: Idle = ()) -> int:
        """Least key increment if it opens then or later."""
        openings = self._openings
        least = openings.without[epoch]
        for offer in self._from(state):
            if offer.least >= least:
                break
            if openings.later[offer.need][epoch] + offer.cost < least:
                total = openings.total(offer.need, offer.cost, soonest(offer.epochs, idle), epoch)
                least = min(least, total)
        return least - self._spent[epoch]

    def _from(self, state: int) -> list[Offer]:
        """What robots can do from a packed state, the best first."""
        at = state & self._outside
        offers = self._offers.get(at)
        if offers is None:
            offers = sorted(self._that_may_pay(state))
            self._offers.keep(at, offers, len(offers))
        return offers

    def _that_may_pay(self, state: int) -> Iterator[Offer]:
        """What robots can do from a packed state that may be better than to do without."""
        for need, provided in self._needs.items():
            least = self._openings.later[need][0]
            cost = 0 if provided is None else provided.cost(state)
            if least + cost < self._too_dear:
                offer = Offer(least + cost, cost, (0,) if provided is None else provided.each(state), need)
                yield self._known.setdefault(offer, offer)
