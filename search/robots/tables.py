"""Tables of robots that follow from the packed task."""

from functools import partial

from search.packed.packed_task import PackedTask
from search.packed.table import KeptTable
from search.robots.decoupled import Decoupled
from search.robots.transition_graphs import PositionVariables, TransitionGraphs


class RobotTables:
    """Tables that hold for every state, but for one goal.

    Attributes:
        positions: the place of each robot, and what moves it.
        transitions: what robots' ops do to each variable.
        decoupled: the walks of robots that can be folded.
    """

    def __init__(self, packed: PackedTask) -> None:
        positions = KeptTable(partial(PositionVariables, packed))
        self.positions = positions
        self.transitions = KeptTable(lambda deadline: TransitionGraphs(packed, positions(deadline)))
        self.decoupled = KeptTable(lambda deadline: Decoupled(packed, positions(deadline), deadline))
