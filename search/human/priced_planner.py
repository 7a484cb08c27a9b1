"""The human alone in the keys of a call: what one call finds serves others that weigh otherwise."""

from search.human.individual_planner import FoundPlan, IndividualPlanner, Memory
from search.human.pattern_database import PatternDatabase
from search.human.plan_graph import PlanGraph
from search.packed.cost_vector import INFINITE_KEY, Weights, own_weights
from search.packed.packed_task import PackedTask
from search.packed.successor_generator import Lookup
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import HumanPlan


class PricedPlanner:
    """:class:`IndividualPlanner` to ``G_H``, in the keys of a call; what it finds serves other calls.

    Args:
        packed: the packed task.
        bound: what :func:`.own_projection` finds.
        memory: what earlier calls have found, see :func:`own_memory`.
        weights: key increments of the call, which say nothing of communication.
        deadline: polled at each state that comes up.
    """

    def __init__(
        self, packed: PackedTask, bound: PatternDatabase, memory: Memory, weights: Weights, deadline: Deadline
    ) -> None:
        own = own_weights(packed)
        self._alone = IndividualPlanner(
            packed, packed.goal, lambda op: own[op.cost], bound, deadline, memory, own_unit=True
        )
        self._weights = weights

    def key(self, state: int, limit: int = INFINITE_KEY) -> int:
        """See :class:`HumanOptimum`."""
        if limit >= INFINITE_KEY:
            found = self._alone.key(state)
        else:
            found = self._alone.key(state, self._weights.own_limit(limit))
        return found if found >= INFINITE_KEY else self._weights.of_own({state: found})[state]

    def canonical(self, state: int) -> FoundPlan | None:
        """See :class:`HumanOptimum`."""
        return self._alone.canonical(state)

    def first_plan(self, state: int) -> tuple[int, ...] | None:
        """See :class:`HumanOptimum`."""
        return self._alone.first_plan(state)

    def best_plan(self, state: int) -> FoundPlan | None:
        """See :class:`HumanOptimum`."""
        return self._alone.best_plan(state)

    def least(self, state: int) -> int:
        """See :class:`HumanOptimum`."""
        found = self._alone.least(state)
        return found if found >= INFINITE_KEY else self._weights.of_own({state: found})[state]

    def plans(self, state: int) -> PlanGraph | None:
        """See :class:`HumanOptimum`."""
        return self._alone.plans(state)

    def proved(self, state: int, plan: HumanPlan) -> None:
        """See :class:`HumanOptimum`."""
        self._alone.proved(state, plan)


def own_memory(packed: PackedTask) -> Memory:
    """Nothing yet, in the unit of :func:`.own_weights`."""
    own = own_weights(packed)
    return Memory(Lookup(packed.own_index, lambda op: own[op.cost]))
