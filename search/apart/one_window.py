"""What robots can have left behind if the window is in one epoch, and what that is worth."""

from collections.abc import Callable, Collection, Mapping, Sequence

import numpy as np

from search.short_windows.independent.conditions import lost_values
from search.short_windows.independent.landmarks import Landmark, Landmarks
from search.short_windows.independent.outcomes import Outcomes, Together, outcomes
from search.short_windows.independent.provision import Provision, Value
from search.short_windows.independent.remaining import Remaining, left_to_pay, values
from search.short_windows.independent.rows import Amounts, column, states
from search.short_windows.independent.timeline import Timeline, TooManyStatesError
from search.short_windows.independent.window import ACTION, FEW, Window
from search.call.context import SearchContext
from search.packed.cost_vector import FAR
from search.packed.operators import Operator


class OneWindow(Window):
    """What robots can have left behind by the end of a window of one epoch, in which the human waits.

    Args:
        context: of the call.
        timelines: robots, up to the window.
        landmarks: of the human's own task.
        lost: by field the values from which the human can't get to their goal.
        base: the packed state before it without them.
        start: key of what comes before it, and of the window.
        limit: key from which on nothing is of interest.
    """

    def __init__(
        self,
        context: SearchContext,
        timelines: Sequence[Timeline],
        landmarks: Landmarks,
        lost: Mapping[int, Collection[int]],
        base: int,
        start: int,
        limit: int,
    ) -> None:
        super().__init__(context, landmarks, base, start)
        self._epochs = timelines[0].epochs
        self._timelines = timelines
        self._fields = [field for field in context.packed.fields if field & context.relevant]
        self._shared: list[int] = []
        self._apart: list[Outcomes] = []
        self._leave_behind(lost)
        self.is_exact = all(timeline.is_exact for timeline in timelines)
        self._given = self._values()
        self._together: Together | None = None
        self._join(limit)

    def _leave_behind(self, lost: Mapping[int, Collection[int]]) -> None:
        """What each robot can leave behind on its own."""
        deadline = self._context.deadline
        for timeline in self._timelines:
            others = 0
            for other in self._timelines:
                others |= 0 if other is timeline else other.changes
            own = [field for field in self._fields if field & timeline.changes]
            self._shared.append(others & sum(own))
            self._apart.append(outcomes(timeline.ends(), self._base, own, others, lost, deadline))

    def _values(self) -> set[Value]:
        """The values that fields can have."""
        found = set()
        for apart in self._apart:
            rows = apart.rows ^ column(self._base, len(apart.rows))
            found |= values(rows, self._fields)
        return found

    def _join(self, limit: int) -> None:
        """Put together what each of them leaves behind."""
        most = self._most(limit)
        pairs = np.prod([len(apart.amounts) for apart in self._apart], dtype=np.float64)
        found = self._landmarks.of(self._base, self._given) if pairs > FEW else []
        finite = [landmark for landmark in found if landmark.cost < FAR]
        own = sum(landmark.cost for landmark in finite)
        nets = [apart.amounts - self._saved(apart, finite, own) for apart in self._apart]
        deadline = self._context.deadline
        try:
            self._together = Together(
                self._apart, nets, self._fields, most - own, self._most_paid(), deadline
            )
        except TooManyStatesError:
            self._least = max(0, own + sum(int(net.min(initial=0)) for net in nets))
            return
        self._remaining = Remaining(self._together.found, self._base)
        self._remaining.learn(found)

    def _most_paid(self) -> int:
        """An amount that robots together can't pay, as each does at most one thing an epoch."""
        context = self._context
        dearest = max(map(context.weights.scaled_cost, context.packed.others))
        return (dearest * len(self._timelines) * (self._epochs + 1) + 1) * ACTION

    def _saved(self, apart: Outcomes, landmarks: Sequence[Landmark], own: int) -> Amounts:
        """What of landmarks the human need not pay for after each of a robot's outcomes."""
        return own - left_to_pay(landmarks, apart.rows ^ column(self._base, len(apart.rows)))

    def ways(self, place: int) -> list[list[Operator]]:
        """What robots do epoch by epoch for something that they leave behind."""
        assert self._together is not None, "there is something"
        epochs: list[list[Operator]] = [[] for _ in range(self._epochs + 1)]
        parts = self._together.parts(place)
        for timeline, apart, shared, part in zip(
            self._timelines, self._apart, self._shared, parts, strict=True
        ):
            change = states(apart.rows[:, part : part + 1])[0]
            mask = 0
            for field in self._fields:
                if field & timeline.changes and (change & field or not field & shared):
                    mask |= field
            way = timeline.way(self._epochs, mask, (self._base ^ change) & mask, int(apart.amounts[part]))
            for epoch, op in enumerate(way):
                if op is not None:
                    epochs[epoch].append(op)
        return epochs


class RobotsApart:
    """Robots one by one beside the human's plan, each told by the states that it can bring about.

    Args:
        context: of the call.
        steps: the human's plan.
        others: per robot what it takes from others for nothing.
        amount: of an operator.
    """

    def __init__(
        self,
        context: SearchContext,
        steps: Sequence[Operator],
        others: Mapping[int, Provision],
        amount: Callable[[Operator], int],
    ) -> None:
        packed, deadline = context.packed, context.deadline
        self._context = context
        self._lost = lost_values(packed)
        self._landmarks = Landmarks(packed, amount, deadline)
        strict, relevant = context.options.strict, context.relevant
        self._timelines = [
            Timeline(packed, robot, steps, provided, relevant, amount, strict=strict, deadline=deadline)
            for robot, provided in others.items()
        ]

    def window(self, base: int, start: int, limit: int) -> OneWindow:
        """A window in the next epoch.

        Args:
            base: the packed state before it without robots.
            start: key of what comes before it, and of the window.
            limit: key from which on nothing is of interest.

        Raises:
            LimitReachedError: there are too many states, or the deadline came.
        """
        return OneWindow(self._context, self._timelines, self._landmarks, self._lost, base, start, limit)

    def follow(self, _: Operator, most: int) -> None:
        """One more epoch of the human's plan.

        Args:
            most: states that cost as much are left out.

        Raises:
            LimitReachedError: there are too many states, or the deadline came.
        """
        for timeline in self._timelines:
            timeline.follow(most)
