"""The human alone as a problem for the kernel."""

from search.classical.planner import ClassicalPlanner
from search.classical.problem import classical_problem
from search.kernel.library import library
from search.packed.cost_vector import own_costs
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.resources.deadline import Deadline


def own_planner(
    packed: PackedTask, goal: PackedGoal, mask: int, deadline: Deadline
) -> ClassicalPlanner | None:
    """A planner whose amounts are in the unit of :func:`.own_weights`; None without a kernel that could.

    Args:
        mask: the fields that matter.
        deadline: asked for memory.
    """
    kernel = library()
    if kernel is None:
        return None
    costs = own_costs(packed)
    fields = ((field, len(packed.values(field))) for field in packed.fields if field & mask)
    problem = classical_problem(fields, packed.own, [costs[op.cost] for op in packed.own], goal)
    return None if problem is None else ClassicalPlanner(kernel, problem, deadline)
