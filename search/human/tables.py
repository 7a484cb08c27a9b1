"""What the human can do alone, as far as it follows from the packed task alone."""

from collections.abc import Callable

from search.human.individual_planner import Memory
from search.human.pattern_database import (
    PatternDatabase,
    Projected,
    human_steps,
    own_projection,
    partial_graph,
    steps_in,
    whole_graph,
)
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline


class HumanTables:
    """Tables that serve every call on a packed task, each built when it is first asked for.

    They hold for each state from which nothing else can be reached (:meth:`covers`), but for one goal.

    Args:
        packed: the packed task.
        project: makes the projection; None: from the packed task.
    """

    def __init__(
        self, packed: PackedTask, project: Callable[[Deadline], PatternDatabase] | None = None
    ) -> None:
        self._packed = packed
        self._project = project or self._own_projection
        self._graph: Projected | None = None
        self._whole: tuple[Projected | None] | None = None
        self._projection: PatternDatabase | None = None
        self._steps: PatternDatabase | None = None
        self._memory: Memory | None = None

    def covers(self, state: int) -> bool:
        """Whether they are known to hold from a packed state: nothing else can be reached from there."""
        return self._graph is not None and state & self._graph.mask in self._graph.moves

    def keeps_all(self, deadline: Deadline) -> bool:
        """Whether the projection keeps all private variables: where they are too many, it says less."""
        return self._project != self._own_projection or self._whole_graph(deadline) is not None

    def graph(self, deadline: Deadline) -> Projected:
        """The human's actions, projected onto their private variables, or onto as many as stay tractable."""
        if self._graph is None:
            self._graph = self._whole_graph(deadline) or partial_graph(self._packed, deadline)
        return self._graph

    def _whole_graph(self, deadline: Deadline) -> Projected | None:
        if self._whole is None:
            self._whole = (whole_graph(self._packed, deadline),)
        return self._whole[0]

    def projection(self, deadline: Deadline) -> PatternDatabase:
        """The human's private distances to the goal, in the unit of :func:`.own_weights`."""
        if self._projection is None:
            self._projection = self._project(deadline)
        return self._projection

    def _own_projection(self, deadline: Deadline) -> PatternDatabase:
        return own_projection(self._packed, self.graph(deadline), deadline)

    def steps(self, deadline: Deadline) -> PatternDatabase:
        """The same, counting the human's actions."""
        if self._steps is None:
            if len(self._packed.costs) == 1:  # every action costs the same: the cheapest way is the shortest
                self._steps = steps_in(self.projection(deadline))
            else:
                self._steps = human_steps(self._packed, self.graph(deadline), deadline)
        return self._steps

    def memory(self) -> Memory:
        """What calls have found out about the human alone."""
        if self._memory is None:
            self._memory = Memory(self._packed)
        return self._memory
