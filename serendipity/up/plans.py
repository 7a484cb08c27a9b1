"""Results as plans of unified-planning, and its plans as ours."""

from collections.abc import Iterable
from typing import Any

import networkx
from unified_planning.plans import ActionInstance, PartialOrderPlan, Plan, PlanKind, SequentialPlan

from serendipity.model import Result, UsageError
from serendipity.up.order import ordered
from serendipity.up.reading import Reading, read
from serendipity.up.vocabulary import ALONE, UPProblem, Vocabulary


class EpochPlan(PartialOrderPlan):
    """A partial order plan that knows in which epoch each of its actions was meant to be.

    Args:
        adjacency_list: as of ``PartialOrderPlan``.
        environment: likewise.
        epochs: the epoch of each action, from 1.

    Attributes:
        epochs: as given.
    """

    def __init__(
        self,
        adjacency_list: dict[ActionInstance, list[ActionInstance]],
        environment: Any = None,
        epochs: dict[ActionInstance, int] | None = None,
    ) -> None:
        super().__init__(adjacency_list, environment)
        self.epochs = epochs or {}


def to_plan(result: Result, problem: UPProblem, *, sequential: bool = False) -> Plan | None:
    """The plan of a result, as a plan of the problem that :func:`from_problem` made its task of.

    Args:
        result: the answer of a planning call.
        problem: the problem.
        sequential: whether a ``SequentialPlan`` is wanted; else what several agents do is an
            :class:`EpochPlan`, a ``PartialOrderPlan`` all of whose orders are plans.

    Returns:
        The plan; None where the result has none.

    Raises:
        PlanError: the result is not of this problem, or its plan can be executed in epochs only.
    """
    if result.plan is None:
        return None
    agents = [name for name in result.agent_costs if name != result.human]
    alone = result.human == ALONE and not agents
    names = Vocabulary(problem).agent_names
    human, robots = names.get(result.human, result.human), [names.get(name, name) for name in agents]
    return plan_of(result, read(problem, None if alone else human, robots or None), sequential=sequential)


def plan_of(result: Result, reading: Reading, *, sequential: bool = False) -> Plan | None:
    """:func:`to_plan` for those who have read the problem."""
    if result.plan is None:
        return None
    order = ordered(reading.task, result.plan)
    instances = [reading.vocabulary.instance(step.action) for step in order.steps]
    environment = reading.vocabulary.problem.environment
    if sequential or len(reading.task.agents) == 1:
        return SequentialPlan(instances, environment)
    after: dict[ActionInstance, list[ActionInstance]] = {instance: [] for instance in instances}
    for first, second in order.before:
        after[instances[first]].append(instances[second])
    epochs = {instance: step.epoch for instance, step in zip(instances, order.steps, strict=True)}
    return EpochPlan(after, environment, epochs)


def human_plan_of(plan: Plan | Iterable[str], reading: Reading) -> tuple[str, ...]:
    """What the human does in a plan, as names of actions.

    Args:
        plan: a plan of the problem, in which others may act as well, or names.
        reading: the problem.

    Raises:
        UsageError: it is a plan of another kind, or of another problem.
    """
    if not isinstance(plan, Plan):
        return tuple(plan)
    names = [reading.vocabulary.name_of(instance) for instance in in_order(plan)]
    task = reading.task
    human = task.agents[task.human]
    own = {task.actions[i].name for i in task.human_actions}
    others = {action.name for action in task.actions if task.human not in action.participants}
    joint = next(
        (name for name in names if name not in own and name not in others and not task.waits(name)), None
    )
    if joint is not None:
        raise UsageError(f"human_plan: '{joint}' is not an action that {human} can do alone")
    return tuple(name for name in names if name not in others)


def in_order(plan: Plan) -> list[ActionInstance]:
    """The actions of a plan, one after another.

    Raises:
        UsageError: it is a plan of another kind.
    """
    if plan.kind == PlanKind.SEQUENTIAL_PLAN:
        return list(plan.actions)
    if plan.kind == PlanKind.PARTIAL_ORDER_PLAN:
        graph = networkx.DiGraph(plan.get_adjacency_list)
        return list(networkx.topological_sort(graph))
    raise UsageError(f"{plan.kind.name}: expected a sequential or a partial order plan")
