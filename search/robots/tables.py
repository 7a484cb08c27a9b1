"""What robots can do, as far as it follows from the packed task alone."""

from search.packed.packed_task import PackedTask
from search.robots.decoupled import Decoupled
from search.robots.transition_graphs import PositionVariables, TransitionGraphs
from serendipity.model.resources.deadline import Deadline


class RobotTables:
    """Tables that serve every call on a packed task, each built when it is first asked for.

    They hold for every state, but for one goal.

    Args:
        packed: the packed task.
    """

    def __init__(self, packed: PackedTask) -> None:
        self._packed = packed
        self._positions: PositionVariables | None = None
        self._transitions: TransitionGraphs | None = None
        self._decoupled: Decoupled | None = None

    def positions(self, deadline: Deadline) -> PositionVariables:
        """The place of each robot, and what moves it."""
        if self._positions is None:
            self._positions = PositionVariables(self._packed, deadline)
        return self._positions

    def transitions(self, deadline: Deadline) -> TransitionGraphs:
        """What robots' ops do to each variable."""
        if self._transitions is None:
            self._transitions = TransitionGraphs(self._packed, self.positions(deadline))
        return self._transitions

    def decoupled(self, deadline: Deadline) -> Decoupled:
        """The walks of robots that can be folded."""
        if self._decoupled is None:
            self._decoupled = Decoupled(self._packed, self.positions(deadline), deadline)
        return self._decoupled
