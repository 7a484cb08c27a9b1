"""One window of one epoch: outcomes that robots can leave behind by its end, and what they are worth."""

from collections.abc import Collection, Mapping, Sequence
from typing import Final

import numpy as np

from search.call.context import SearchContext
from search.packed.cost_vector import ACTIONS_BITS, FAR, INFINITE_KEY
from search.packed.operators import Operator, union
from search.short_windows.independent.landmarks import Landmarks, left_to_pay
from search.short_windows.independent.outcomes import Outcomes, Remaining, Together, joined, outcomes, values
from search.short_windows.independent.provision import Value
from search.short_windows.independent.rows import Rows, column, packed_state
from search.short_windows.independent.timeline import RobotLayers, TooManyStatesError

ACTION: Final = 1 << ACTIONS_BITS
"""Amounts are costs in these units, and a number of actions."""

_FEW: Final = 50
"""So many outcomes are told one by one sooner than by landmarks."""


class Window:
    """A window of one epoch, in which the human waits, by the outcomes that robots can leave behind.

    Args:
        timelines: robots, up to the window.
        landmarks: of the human's own task.
        lost: by field the values from which the human can't get to their goal.
        base: the packed state before it without them.
        start: key of what comes before it, and of the window.
        limit: key from which on nothing is of interest.

    Attributes:
        found: the least key of what was looked at.

    Raises:
        LimitReachedError: there are too many states, or the deadline came.
    """

    def __init__(
        self,
        context: SearchContext,
        timelines: Sequence[RobotLayers],
        landmarks: Landmarks,
        lost: Mapping[int, Collection[int]],
        base: int,
        start: int,
        limit: int,
    ) -> None:
        self.found = INFINITE_KEY
        self._context = context
        self._timelines = timelines
        self._landmarks = landmarks
        self._base = base
        self._start = start
        self._epochs = timelines[0].epochs
        self._fields = [field for field in context.packed.fields if field & context.relevant]
        self._shared: list[int] = []
        self._apart: list[Outcomes] = []
        self._leave_behind(lost)
        # Whether robots can do what is looked at: nothing was forgotten by now.
        self._is_exact = all(timeline.is_exact for timeline in timelines)
        left = [apart.rows ^ column(base, len(apart.rows)) for apart in self._apart]
        self._given = set[Value]().union(*(values(rows, self._fields) for rows in left))
        self._together: Together | None = None
        self._remaining: Remaining | None = None
        self._least = 0  # the amount that nothing is below, where there are too many outcomes
        self._join(left, limit)

    def _leave_behind(self, lost: Mapping[int, Collection[int]]) -> None:
        """What each robot can leave behind on its own."""
        deadline = self._context.deadline
        for timeline in self._timelines:
            others = union(other.changes for other in self._timelines if other is not timeline)
            own = [field for field in self._fields if field & timeline.changes]
            self._shared.append(others & sum(own))
            self._apart.append(outcomes(timeline.ends(), self._base, own, others, lost, deadline))

    def _join(self, left: Sequence[Rows], limit: int) -> None:
        """Put together what each of them leaves behind, states at first."""
        pairs = np.prod([len(apart.amounts) for apart in self._apart], dtype=np.float64)
        found = self._landmarks.of(self._base, self._given) if pairs > _FEW else []
        finite = [landmark for landmark in found if landmark.cost < FAR]
        own = sum(landmark.cost for landmark in finite)
        saved = (own - left_to_pay(finite, rows) for rows in left)  # of landmarks, after each outcome
        nets = [apart.amounts - less for apart, less in zip(self._apart, saved, strict=True)]
        most, deadline = self._most(limit) - own, self._context.deadline
        try:
            self._together = joined(self._apart, nets, self._fields, most, self._most_paid(), deadline)
        except TooManyStatesError:
            self._least = max(0, own + sum(int(net.min(initial=0)) for net in nets))
            return
        self._remaining = Remaining(self._together, self._base)
        self._remaining.learn(found)

    def _most(self, limit: int) -> int:
        """The amount from which on nothing is of interest, by a limit on keys."""
        return self._context.weights.amount_from(limit - self._start, FAR)

    def _most_paid(self) -> int:
        """An amount that robots together can't pay, as each does at most one thing an epoch."""
        context = self._context
        dearest = max(map(context.weights.scaled_cost, context.packed.others))
        return (dearest * len(self._timelines) * (self._epochs + 1) + 1) * ACTION

    @property
    def bound(self) -> int:
        """No plan with this window has a smaller key, but for what was too dear when it was asked for."""
        least = self._least
        if self._remaining is not None:
            if not len(self._remaining):
                return self.found
            least = self._remaining.least
        return min(self.found, self._start + self._context.weights.key_of(least))

    def is_open(self, limit: int) -> bool:
        """Whether something is left that may be below a limit."""
        if self._remaining is None or (self.found < limit and not self._is_exact):
            return False
        self._remaining.drop(self._most(limit))
        return len(self._remaining) > 0

    def look(self, limit: int) -> int | None:
        """Look at an outcome: its place if it is below a limit."""
        context, alone = self._context, self._context.alone
        assert self._remaining is not None, "it is open"
        context.deadline.check()
        place, state, amount = self._remaining.take()
        paid = self._start + context.weights.key_of(amount)
        if paid + alone.least(state) < limit:
            key = paid + alone.key(state, limit - paid)
            if key < limit:
                self.found = min(self.found, key)
                return place if self._is_exact else None
        if len(self._remaining) > _FEW:
            self._remaining.learn(self._landmarks.of(state, self._given))
        return None

    def ways(self, place: int) -> list[list[Operator]]:
        """What robots do epoch by epoch for something that they leave behind."""
        assert self._together is not None, "there is something"
        epochs: list[list[Operator]] = [[] for _ in range(self._epochs + 1)]
        parts = map(int, self._together.parts[:, place])
        for timeline, apart, shared, part in zip(
            self._timelines, self._apart, self._shared, parts, strict=True
        ):
            change = packed_state(apart.rows, part)
            own = (field for field in self._fields if field & timeline.changes)
            mask = union(field for field in own if change & field or not field & shared)
            way = timeline.way(self._epochs, mask, (self._base ^ change) & mask, int(apart.amounts[part]))
            for epoch, op in enumerate(way):
                if op is not None:
                    epochs[epoch].append(op)
        return epochs
