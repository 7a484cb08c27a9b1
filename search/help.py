"""A lower bound that asks who helps: nothing gets cheaper unless robots provide a touch.

Whatever happens after a node, the human either touches nothing outside any more,
or there is a first touch.  Until then he moves by himself in his private fields,
and only robots change what lies outside; so the node costs at least what robots
need to provide the touch, plus his way to it, the touch, and his private rest
(``search.projection``), and there must be epochs enough for both.  Touches that
are too dear already from the initial state stay so, since both parts are
distances: a first pass leaves few of them.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from itertools import accumulate, pairwise
from operator import itemgetter
from typing import NamedTuple, Protocol

from search.clock import Clock
from search.encoding import Encoding, Op
from search.keys import INFINITE_KEY
from search.projection import Projection
from search.provision import Distances, Places, Provision
from search.successors import Idle
from search.touches import Touches
from search.ways import NEVER, Ways

_MOST_TOUCHES = 1024
"""More surviving needs than this make the bound dearer than what it saves."""


class Timed(Protocol):
    """Lower bound of the key increment from an epoch and a packed state after it."""

    def __call__(self, epoch: int, state: int, spent: int, idle: Idle = (), /) -> int:
        """The bound.

        Args:
            epoch: how many have passed.
            state: the packed state after it.
            spent: the key so far; what would end dearer than the bound needs no close look.
            idle: for how many epochs robots have been idle.
        """


class Choice(NamedTuple):
    """One way on from a packed state before the first touch.

    Attributes:
        total: least key increment.
        steps: least number of epochs in which robots act first.
        latest: the last epoch by which they must have.
    """

    total: int
    steps: int
    latest: int


class Provided:
    """Least key increment, and least number of epochs, for robots to provide a need.

    Args:
        need: its id.
        by_cost: what robots can do, weighed.
        by_step: the same, counting epochs; None where the weight tells them.
        unit: weight of an epoch, then.
    """

    def __init__(self, need: int, by_cost: Provision, by_step: Provision | None, unit: int) -> None:
        self._need = need
        self._by_cost = by_cost
        self._by_step = by_step
        self._unit = unit

    @cached_property
    def cost(self) -> Distances:
        """Least key increment from a packed state."""
        return self._by_cost.distances(self._need)

    @cached_property
    def _steps(self) -> Distances:
        return self.cost if self._by_step is None else self._by_step.distances(self._need)

    def epochs(self, state: int, idle: Idle) -> int:
        """In how many epochs from now the need can be provided, from a packed state.

        Robots that have been idle may have walked meanwhile, where walks are folded.
        """
        if not idle:
            return self._steps(state) // self._unit
        return max(0, min(epochs - rest for epochs, rest in zip(self.each(state), idle, strict=True)))

    def each(self, state: int) -> tuple[int, ...]:
        """The same without a rest, per robot that may act first."""
        return tuple(steps // self._unit for steps in self._steps.each(state))


class Providers:
    """The robots' side.

    Args:
        encoding: the packed task.
        touches: what the human's ops mention.
        weights: key increment of a robots' op by the index of its cost.
        followed: the ops of ``pi_H``, in order, where the human follows it for a while.
        clock: asked for time.

    A need that is judged by a field that ``pi_H`` changes counts twice: before that
    happens, and, under the id ``late(need)``, afterwards.
    """

    def __init__(
        self,
        encoding: Encoding,
        touches: Touches,
        weights: Sequence[int],
        followed: Sequence[Op],
        clock: Clock,
    ) -> None:
        self._encoding = encoding
        self._touches = touches
        self._weights = weights
        self._followed = followed
        self._clock = clock
        self._changes: dict[int, int] = {}
        self._judges: dict[int, int] = {}
        for epoch, op in enumerate(followed, start=1):
            for field in encoding.fields:
                if field & ~op.keep:
                    self._changes.setdefault(field, epoch)
        self._shared = _shared_fields(encoding, touches, clock)
        used = {weights[index] for index in encoding.derived(_robots_costs)}
        self._uniform = len(used) <= 1
        self._unit = max(used, default=1)
        self._by_cost: dict[tuple[int, bool], Provision] = {}
        self._by_step: dict[tuple[int, bool], Provision] = {}

    def at(self, need: int, epoch: int) -> int:
        """The id that a need goes by after ``epoch`` epochs of ``pi_H``."""
        changed = self._changes.get(self._judged_by(need))
        return need if changed is None or epoch < changed else self._late(need)

    def phases(self, epochs: int) -> list[tuple[int, int]]:
        """Stretches of ``0 .. epochs - 1`` between which ``pi_H`` changes something outside."""
        shared = (change for field, change in self._changes.items() if field in self._shared)
        cuts = sorted({0, epochs, *(change for change in shared if change < epochs)})
        return list(pairwise(cuts))

    @staticmethod
    def touched(need: int) -> int:
        """The need behind an id of :meth:`at`."""
        return need if need >= 0 else -1 - need

    @staticmethod
    def _late(need: int) -> int:
        return -1 - need

    def costs(self, needs: Sequence[int], pays: Callable[[int], bool]) -> dict[int, int]:
        """Least cost from the initial state per need, as far as it can pay.

        Args:
            needs: their ids.
            pays: whether anything can pay for which robots need this cost, or more.
        """
        return self._explore(self._by_cost, needs, self._weights, pays)

    def epochs(self, cost: int) -> int:
        """At least so many epochs go into what costs robots a key increment."""
        return cost // self._unit if self._uniform else 0

    def provided(self, needs: Sequence[int], horizon: int) -> dict[int, Provided]:
        """Bounds from any packed state, for needs that :meth:`costs` found.

        Args:
            needs: their ids.
            horizon: number of epochs; beyond it steps are not told apart.
        """
        unit = self._unit
        if not self._uniform:
            self._explore(self._by_step, needs, [1] * len(self._weights), horizon.__ge__)
            unit = 1
        found = {}
        for need in needs:
            group = self._group(need)
            found[need] = Provided(need, self._by_cost[group], self._by_step.get(group), unit)
        return found

    def _explore(
        self,
        provisions: dict[tuple[int, bool], Provision],
        needs: Sequence[int],
        weights: Sequence[int],
        pays: Callable[[int], bool],
    ) -> dict[int, int]:
        groups: dict[tuple[int, bool], list[int]] = {}
        for need in needs:
            groups.setdefault(self._group(need), []).append(need)
        costs: dict[int, int] = {}
        for (field, late), members in groups.items():
            listed = [(i, self._touches.needs[self.touched(i)]) for i in members]
            flips = self._followed if late else ()
            provision = Provision(self._encoding, field, listed, weights, flips, self._clock)
            provision.explore(pays)
            provisions[field, late] = provision
            costs.update(provision.cost)
        return costs

    def _group(self, need: int) -> tuple[int, bool]:
        """The field that judges a need, and whether ``pi_H`` has changed it by then."""
        touched = self.touched(need)
        return self._judged_by(touched), touched != need

    def _judged_by(self, need: int) -> int:
        """The first shared field that the need asks for; 0: only places matter."""
        field = self._judges.get(need)
        if field is None:
            mask = self._touches.needs[need].mask
            field = self._judges[need] = next((f for f in self._shared if mask & f), 0)
        return field


def _robots_costs(encoding: Encoding) -> frozenset[int]:
    return frozenset(op.cost for op in encoding.others)


def _shared_fields(encoding: Encoding, touches: Touches, clock: Clock) -> list[int]:
    """Outside fields that are no robot's place, the largest first."""
    places = set(encoding.derived(Places, clock).field.values())
    outside = [f for f in encoding.fields if f & touches.outside and f not in places]
    return sorted(outside, key=lambda f: (-len(encoding.values(f)), f))


def survivors(costs: dict[int, int], limit: int, total: Callable[[int, int], int]) -> list[int] | None:
    """Needs whose touch may still pay; None if they are too many to look at one by one.

    Args:
        costs: what it costs robots, at least, to provide each.
        limit: what has to be beaten.
        total: least total by need and robots' cost.
    """
    paying = [need for need, cost in costs.items() if total(need, cost) < limit]
    return paying if len(paying) <= _MOST_TOUCHES else None


class Helped:
    """The bound at any node before the first touch, over the surviving needs.

    Args:
        bound: private distances to the goal.
        ways: the human's side.
        needs: the surviving needs with the least totals of plans that touch them first; one may
            stand there twice, before and after ``pi_H`` has changed what it is judged by.
        horizon: number of epochs.
    """

    def __init__(
        self, bound: Projection, ways: Ways, needs: Iterable[tuple[int, Provided, int]], horizon: int
    ) -> None:
        self._mask = bound.mask
        self._ways = ways
        self._promises = [
            _Promise(ways, need, provided, total, horizon)
            for need, provided, total in sorted(needs, key=itemgetter(2))
        ]
        self._cheap: dict[int, list[tuple[int, Provided, int]]] = {}

    @cached_property
    def _without(self) -> dict[int, int]:
        return self._ways.to_goal()

    def __call__(self, epoch: int, state: int, spent: int, idle: Idle = (), /) -> int:
        """See :class:`Timed`."""
        at = state & self._mask
        least = self._without.get(at, INFINITE_KEY)
        for promise in self._promises:
            if promise.total - spent >= least:
                break
            total = promise.way.get(at, INFINITE_KEY)
            if total >= least:
                continue
            total += promise.provided.cost(state)
            if total < least and epoch + promise.provided.epochs(state, idle) <= promise.latest:
                least = total
        return least

    def choices(self, state: int) -> list[Choice]:
        """All that the bound is the least of, ascending; none has a cheaper one that is never later."""
        at = state & self._mask
        least = self._without.get(at, INFINITE_KEY)
        found = []
        for cost, provided, latest in self._from(at, least):
            total = cost + provided.cost(state)
            if total < least:
                found.append((total, provided.epochs(state, ()), latest))
        found.sort()
        kept: list[Choice] = []
        soonest = NEVER
        for total, steps, latest in (*found, (least, 0, NEVER)):
            if steps < soonest or all(k.steps > steps or k.latest < latest for k in kept):
                kept.append(Choice(total, steps, latest))
                soonest = min(soonest, steps)
        return kept

    def _from(self, at: int, least: int) -> list[tuple[int, Provided, int]]:
        """What costs him less than doing without, from a projected state."""
        known = self._cheap.get(at)
        if known is None:
            costs = ((p.way.get(at, INFINITE_KEY), p.provided, p.latest) for p in self._promises)
            known = self._cheap[at] = [entry for entry in costs if entry[0] < least]
        return known


class _Promise:
    """A need that may pay, with the human's ways to its touches once they are asked for."""

    def __init__(self, ways: Ways, need: int, provided: Provided, total: int, horizon: int) -> None:
        self._ways = ways
        self._need = need
        self.provided = provided
        self.total = total
        self.latest = horizon - 1 - ways.steps_after[need]

    @cached_property
    def way(self) -> dict[int, int]:
        """Least key to the goal with a first touch of the need, by projected state."""
        return self._ways.through(self._need)


def no_bound(_epoch: int, _state: int, _spent: int, _idle: Idle = (), /) -> int:
    """The bound that is always right."""
    return 0


class Bounds:
    """Which bound holds at a node.

    The first pass of this module judges the *first* touch only; once there has been one,
    the private bound is what holds.

    Args:
        private: distances in the human's private fields.
        steps: the same, counting actions.
        untouched: bound before the first touch.
        touches: tells which actions are touches.
    """

    def __init__(self, private: Projection, steps: Projection, untouched: Timed, touches: Touches) -> None:
        self.private = private
        self.steps = steps
        self.untouched = untouched
        self._is_touch = touches.is_touch

    def touches(self, actions: Sequence[int]) -> bool:
        """Whether the human's part of an epoch (at most one action) is a touch."""
        return bool(actions) and self._is_touch(actions[0])


class Openings:
    """The human's totals while he follows ``pi_H``, by need and by the epoch before the window.

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
        """Least total at all, if robots need some epochs to provide what he touches."""
        opens = max(0, steps - self.reach)
        return self.floor[opens] if opens < len(self.floor) else INFINITE_KEY


class Offer(NamedTuple):
    """What robots can do about a need from where they are.

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

    def soonest(self, idle: Idle) -> int:
        """In how many epochs from now, where robots have been idle for some."""
        if not idle:
            return min(self.epochs)
        return max(0, min(epochs - rest for epochs, rest in zip(self.epochs, idle, strict=False)))


class HelpedOnTheWay:
    """The bound while the human follows ``pi_H``; a window has still to open.

    Args:
        openings: his totals.
        spent: what following ``pi_H`` has cost by each epoch.
        needs: the surviving needs; None where robots may provide them for nothing.
        outside: the fields on which their costs depend.
    """

    def __init__(
        self,
        openings: Openings,
        spent: Sequence[int],
        needs: dict[int, Provided | None],
        outside: int,
    ) -> None:
        self._openings = openings
        self._spent = spent
        self._needs = needs
        self._outside = outside
        self._offers: dict[int, list[Offer]] = {}
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
            total = openings.now[offer.need][opens] + offer.cost
            if total < least and epoch + offer.soonest(idle) <= min(openings.latest[offer.need], until):
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
                total = openings.total(offer.need, offer.cost, offer.soonest(idle), epoch)
                least = min(least, total)
        return least - self._spent[epoch]

    def _from(self, state: int) -> list[Offer]:
        """What robots can do from a packed state, the best first."""
        at = state & self._outside
        offers = self._offers.get(at)
        if offers is None:
            offers = self._offers[at] = sorted(
                self._offer(need, provided, state) for need, provided in self._needs.items()
            )
        return offers

    def _offer(self, need: int, provided: Provided | None, state: int) -> Offer:
        least = self._openings.later[need][0]
        if provided is None:
            return Offer(least, 0, (0,), need)
        cost = provided.cost(state)
        return Offer(least + cost, cost, provided.each(state), need)
