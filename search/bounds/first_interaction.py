"""A lower bound that asks who helps: nothing gets cheaper unless robots provide a touch.

Whatever happens after a node, the human either touches nothing outside any more,
or there is a first touch.  Until then they move alone in their private fields,
and only robots change what lies outside; so the node costs at least what robots
need to provide the touch, plus their way to it, the touch, and their private rest
(``search.human.pattern_database``), and there must be epochs enough for both.  Touches that
are too dear already from the initial state stay so, since both parts are
distances: a first pass leaves few of them.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property, partial
from operator import itemgetter
from typing import NamedTuple

from search.bounds.achievers import Provided
from search.bounds.interactions import Interactions
from search.bounds.private_distances import UNTOUCHED, Corridor, PrivateDistances, ways_through
from search.human.pattern_database import PatternDatabase
from search.packed.cost_vector import INFINITE_KEY, NEVER
from search.packed.joint_actions import Idle

_MOST_TOUCHES = 4096
"""More surviving needs than this make the bound dearer than what it saves."""


Timed = Callable[[int, int, int, Idle], int]
"""Lower bound of the key increment: from how many epochs, the packed state after them, the key so far (what
would end dearer than the bound needs no close look), and for how many epochs robots have been idle."""


def survivors(costs: dict[int, int], limit: int, total: Callable[[int, int], int]) -> list[int] | None:
    """Needs whose touch may still pay; None if they are too many to look at one by one.

    Args:
        costs: what it costs robots, at least, to provide each.
        limit: what has to be beaten.
        total: least total by need and robots' cost.
    """
    paying = [need for need, cost in costs.items() if total(need, cost) < limit]
    return paying if len(paying) <= _MOST_TOUCHES else None


class FirstInteraction:
    """The bound at any node before the first touch, over the surviving needs.

    Args:
        ways: the human's side.
        corridors: what was explored of it.
        needs: the surviving needs with the least totals of plans that touch them first; one may
            stand there twice, before and after ``pi_H`` has changed what it is judged by.
    """

    def __init__(
        self,
        ways: PrivateDistances,
        corridors: Sequence[Corridor],
        needs: Iterable[tuple[int, Provided, int]],
    ) -> None:
        self._mask = ways.interactions.mask
        self._outside = ways.outside
        self._through = partial(ways_through, corridors, deadline=ways.deadline)
        self._promises = [
            _Promise(self._through, need, provided, total)
            for need, provided, total in sorted(needs, key=itemgetter(2))
        ]

    @cached_property
    def _without(self) -> dict[int, int]:
        return self._through(UNTOUCHED)

    def __call__(self, epoch: int, state: int, spent: int, idle: Idle, /) -> int:
        """See :data:`Timed`."""
        at, around = state & self._mask, state & self._outside
        least = self._without.get(at, INFINITE_KEY)
        for promise in self._promises:
            if promise.total - spent >= least:
                break
            total = promise.way.get(at, INFINITE_KEY)
            if total >= least:
                continue
            cost = promise.costs.get(around)
            if cost is None:
                cost = promise.costs[around] = promise.provided.cost(state)
            total += cost
            if total < least and epoch + promise.provided.epochs(state, idle) <= promise.latest:
                least = total
        return least

    def choices(self, state: int) -> list[tuple[int, int, int]]:
        """All that the bound is the least of, ascending: totals from a packed state before the first touch.

        With each the number of epochs in which robots act first, and the last epoch by which they must have.
        """
        at = state & self._mask
        least, found = self._without.get(at, INFINITE_KEY), []
        for promise in self._promises:
            cost, provided = promise.way.get(at, INFINITE_KEY), promise.provided
            if cost < least and (total := cost + provided.cost(state)) < least:
                found.append((total, provided.epochs(state, ()), promise.latest))
        return [*sorted(found), (least, 0, NEVER)]


class _Promise:
    """A need that may pay, with the human's ways to its touches once they are asked for.

    Attributes:
        provided: what robots can do about it.
        costs: what they need for it, at least, by the outside fields as far as it was asked.
        total: least total of plans that touch it first.
        latest: the last epoch by which they must have provided it.
    """

    def __init__(
        self, through: Callable[[int], dict[int, int]], need: int, provided: Provided, total: int
    ) -> None:
        self._through = through
        self._need = need
        self.provided = provided
        self.total = total
        self.costs: dict[int, int] = {}
        self.latest = provided.latest

    @cached_property
    def way(self) -> dict[int, int]:
        """Least key to the goal with a first touch of the need, by projected state."""
        return self._through(self._need)


def no_bound(_epoch: int, _state: int, _spent: int, _idle: Idle, /) -> int:
    """The bound that is always right."""
    return 0


def no_team_bound(_state: int, /) -> int:
    """The bound on the team that is always right."""
    return 0


class Bounds(NamedTuple):
    """The bounds of a space, each for its phase of a node.

    The first pass of this module judges the *first* touch only; once there has been one,
    the private bound is what holds.

    Attributes:
        private: distances in the human's private fields.
        steps: the same, counting actions.
        untouched: bound before the first touch.
        touches: tells which actions are touches; None where no bound asks for that.
        team: bound on what the team pays from a packed state, without a look at epochs.
    """

    private: PatternDatabase
    steps: PatternDatabase
    untouched: Timed = no_bound
    touches: Interactions | None = None
    team: Callable[[int], int] = no_team_bound

    def interactions(self, actions: Sequence[int]) -> bool:
        """Whether the human's part of an epoch (at most one action) is a touch."""
        return bool(actions) and self.touches is not None and self.touches.is_interaction(actions[0])
