"""Tables of the human alone that follow from the packed task."""

from collections.abc import Callable
from functools import partial

from search.human.individual_planner import Memory
from search.human.pattern_database import (
    PatternDatabase,
    Projected,
    alone_projection,
    human_steps,
    own_projection,
    partial_graph,
    steps_in,
    whole_graph,
)
from search.packed.packed_task import PackedTask
from search.packed.table import KeptTable
from serendipity.model.resources.deadline import Deadline


class HumanTables:
    """Tables for each state from which nothing else can be reached (:meth:`covers`), but for one goal.

    Args:
        project: makes the projection; None: from the packed task.

    Attributes:
        graph: the human's actions, projected onto their private variables, or onto as many as stay tractable.
        projection: their private distances to the goal, in the unit of :func:`.own_weights`.
        steps: the same, counting their actions.
        alone: what :func:`.alone_projection` finds.
    """

    def __init__(
        self, packed: PackedTask, project: Callable[[Deadline], PatternDatabase] | None = None
    ) -> None:
        self._packed = packed
        self._memories: dict[bool, Memory] = {}
        whole = KeptTable(partial(whole_graph, packed))
        graph = KeptTable(lambda deadline: whole(deadline) or partial_graph(packed, deadline))
        own = KeptTable(lambda deadline: own_projection(packed, graph(deadline), deadline))
        projection = own if project is None else KeptTable(project)
        self._whole = whole if project is None else None
        self.alone = KeptTable(lambda deadline: alone_projection(packed, deadline))
        self.graph: KeptTable[Projected] = graph
        self.projection: KeptTable[PatternDatabase] = projection
        if len(packed.costs) == 1:  # every action costs the same: the cheapest way is the shortest
            self.steps = KeptTable(lambda deadline: steps_in(projection(deadline)))
        else:
            self.steps = KeptTable(lambda deadline: human_steps(packed, graph(deadline), deadline))

    def memory(self, *, strict: bool) -> Memory:
        """What calls have found out about the human alone; interference matters beside a script only."""
        strict = strict and bool(self._packed.clock_bit)
        if strict not in self._memories:
            self._memories[strict] = Memory(self._packed, strict=strict)
        return self._memories[strict]

    def covers(self, state: int) -> bool:
        """Whether they are known to hold from a packed state: nothing else can be reached from there."""
        graph = self.graph.known
        return graph is not None and state & graph[0].mask in graph[0].moves

    def keeps_all(self, deadline: Deadline) -> bool:
        """Whether the projection keeps all private variables: where they are too many, it says less."""
        return self._whole is None or self._whole(deadline) is not None
