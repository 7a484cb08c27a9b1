"""All robots beside the human's plan, told by how many things of each kind they have seen to."""

from collections.abc import Callable

from search.short_windows.independent.alike.counts import Counts
from search.short_windows.independent.alike.robot import Robot
from search.short_windows.independent.alike.tally import Tally
from search.short_windows.independent.alike.window import AlikeWindow, Until
from search.short_windows.independent.landmarks import Landmarks
from search.short_windows.independent.provision import Value
from search.call.context import SearchContext
from search.packed.operators import Operator
from serendipity.model.task.task import HumanPlan


class CountedRobots:
    """Robots, epoch by epoch.

    Args:
        context: of the call.
        plan: ``pi_H``.
        tally: how what they do is counted.
        amount: of an operator.

    Raises:
        TooManyStatesError: a robot has too many places, or too many numbers.
        LimitReachedError: the deadline came.
    """

    def __init__(
        self,
        context: SearchContext,
        plan: HumanPlan,
        tally: Tally,
        amount: Callable[[Operator], int],
    ) -> None:
        packed, deadline = context.packed, context.deadline
        self._context = context
        self._plan = plan
        self._tally = tally
        self._landmarks = Landmarks(packed, amount, deadline)
        self._robots = []
        for agents in sorted({op.agents for op in packed.others}):
            ops = [(op, amount(op)) for op in packed.others if op.agents == agents]
            self._robots.append(Robot(packed, ops, tally, deadline))
        most = [len(counter.values) for counter in tally.counters]
        self._counts = [Counts(robot, most, deadline) for robot in self._robots]
        self._given = self._values()
        self._known = self._landmarks.of(packed.init, self._given)
        self._epochs = 0
        self._spoken: set[str] = set()
        self._grow()

    def _values(self) -> set[Value]:
        """The values that fields can have before and after any window."""
        packed = self._context.packed
        found = {value for counter in self._tally.counters for value in counter.values}
        state = packed.init
        for op in (*map(packed.op, self._plan), None):
            found.update((field, state & field) for field in packed.fields)
            if op is not None:
                state = state & op.keep | op.put
        return found

    def _grow(self) -> None:
        for counts in self._counts:
            counts.grow()

    def window(self, base: int, start: int, limit: int) -> AlikeWindow:
        """A window in the next epoch.

        Args:
            base: the packed state before it without robots.
            start: key of what comes before it, and of the window.
            limit: key from which on nothing is of interest.

        Raises:
            LimitReachedError: there are too many outcomes, or the deadline came.
        """
        spoken = {
            field
            for counter in self._tally.counters
            for field, value in counter.values
            if not self._spoken.isdisjoint(
                self._tally.things.mentioned[field, value] & self._tally.kinds.keys()
            )
        }
        until = Until(self._robots, self._counts, self._tally, spoken, self._epochs, self._given, self._known)
        return AlikeWindow(self._context, self._landmarks, base, start, until, limit)

    def follow(self, step: Operator, most: int) -> None:
        """One more epoch of the human's plan.

        Args:
            step: of the human's plan.
            most: nothing that costs as much is of interest.

        Raises:
            LimitReachedError: the deadline came.
        """
        self._epochs += 1
        self._spoken |= self._tally.things.of(step)
        self._grow()
