"""Results as plans of unified-planning, and its plans as ours.

Epochs become a partial order: what has to come before what, and nothing else.  Actions that share no
agent, and of which neither changes what the other asks for or undoes what it does, may come in any order.
So every order that the partial one allows is a plan, and they all end in the same state.  Plans in time say
when each action begins.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby
from typing import Any, Final

import networkx
from unified_planning.model import DurativeAction
from unified_planning.plans import (
    ActionInstance,
    PartialOrderPlan,
    Plan,
    PlanKind,
    SequentialPlan,
    TimeTriggeredPlan,
)

from serendipity.model import GroundAction, PlanError, PlanStep, Result, Task, UsageError
from serendipity.model.task.actions import apply, in_turn
from serendipity.model.task.plans import PlanEntry, checked_entries
from serendipity_up.reading import ReadProblem, read
from serendipity_up.schedule import start_times, variant_in
from serendipity_up.vocabulary import ALONE, UPProblem, Vocabulary

_NEAR: Final = Fraction(1, 100)
"""Of an epoch: a little time between actions is none."""


@dataclass(frozen=True, slots=True)
class Ordered:
    """Steps of a plan in an order that can be executed, and which come before which (indices), directly."""

    steps: tuple[PlanStep, ...]
    before: tuple[tuple[int, int], ...]


def ordered(task: Task, steps: Iterable[PlanStep]) -> Ordered:
    """The partial order of a plan.

    Raises:
        PlanError: a step is not applicable, or two actions of an epoch each spoil what the other one
            asks for, so that they can be done at once only.
    """
    state, done, actions = task.init, list[PlanStep](), list[GroundAction]()
    for epoch, group in groupby(sorted(steps, key=lambda step: step.epoch), lambda step: step.epoch):
        together = [(step, variant_in(task, step, state)) for step in group]
        order, circle = in_turn([[action] for _, action in together])
        if circle:
            names = ", ".join(f"'{together[i][0].action}'" for i in circle)
            raise PlanError(
                f"epoch {epoch}: {names} can be done at once only, and no plan of unified-planning says so: "
                "plan with interference='strict'"
            )
        done += (together[i][0] for i in order)
        actions += (together[i][1] for i in order)
        state = apply(state, *(action for _, action in together))
    graph = networkx.DiGraph()
    graph.add_nodes_from(range(len(done)))
    for second, later in enumerate(actions):
        graph.add_edges_from(
            (first, second) for first, earlier in enumerate(actions[:second]) if depend(earlier, later)
        )
    return Ordered(tuple(done), tuple(sorted(networkx.transitive_reduction(graph).edges)))


def depend(a: GroundAction, b: GroundAction) -> bool:
    """Whether two actions may not change places."""
    return bool(set(a.participants) & set(b.participants)) or _touches(a, b) or _touches(b, a)


def _touches(a: GroundAction, b: GroundAction) -> bool:
    """Whether what ``a`` does matters to ``b``, or is undone by it."""
    return not (
        set(a.add).isdisjoint((*b.pre, *b.neg, *b.delete))
        and set(a.delete).isdisjoint((*b.pre, *b.neg, *b.add))
    )


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
            :class:`EpochPlan`, a ``PartialOrderPlan`` all of whose orders are plans.  Where actions take time
            it is a ``TimeTriggeredPlan`` anyway.

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


def plan_of(result: Result, reading: ReadProblem, *, sequential: bool = False) -> Plan | None:
    """:func:`to_plan` for those who have read the problem."""
    if result.plan is None:
        return None
    if reading.in_time:
        return _in_time(result.plan, reading)
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


def _in_time(steps: Sequence[PlanStep], reading: ReadProblem) -> TimeTriggeredPlan:
    task = reading.task
    instances = [reading.vocabulary.instance(step.action) for step in steps]
    lasting = [isinstance(instance.action, DurativeAction) for instance in instances]
    times = start_times(task, steps, lasting)
    durations = [task.actions[task.named[step.action][0]].duration * task.epoch for step in steps]
    timed = [
        (time, instance, duration if lasts else None)
        for time, instance, duration, lasts in zip(times, instances, durations, lasting, strict=True)
    ]
    return TimeTriggeredPlan(timed, reading.vocabulary.problem.environment)


def human_plan_of(plan: Plan | Iterable[str], reading: ReadProblem) -> tuple[PlanEntry, ...]:
    """What the human does in a plan, others apart, by names; with epochs where the plan has times."""
    if not isinstance(plan, Plan):
        return checked_entries(plan, "human plan")
    timed = plan.kind == PlanKind.TIME_TRIGGERED_PLAN
    done = [one for _, one, _ in _by_time(plan)] if timed else in_order(plan)
    names = [reading.vocabulary.name_of(instance) for instance in done]
    task = reading.task
    human = task.agents[task.human]
    own = {task.actions[i].name for i in task.human_actions}
    others = {action.name for action in task.actions if task.human not in action.participants}
    joint = next(
        (name for name in names if name not in own and name not in others and not task.waits(name)), None
    )
    if joint is not None:
        raise UsageError(f"human_plan: '{joint}' is not an action that {human} can do alone")
    if not timed:
        return tuple(name for name in names if name not in others)
    epochs = [int(time / task.epoch + _NEAR) + 1 for time, _, _ in _by_time(plan)]
    return tuple(entry for entry in zip(epochs, names, strict=True) if entry[1] not in others)


def _by_time(plan: TimeTriggeredPlan) -> list[tuple[Fraction, ActionInstance, Fraction | None]]:
    return sorted(plan.timed_actions, key=lambda timed: timed[0])


def in_order(plan: Plan) -> list[ActionInstance]:
    """The actions of a plan, one after another."""
    if plan.kind == PlanKind.SEQUENTIAL_PLAN:
        return list(plan.actions)
    if plan.kind == PlanKind.PARTIAL_ORDER_PLAN:
        graph = networkx.DiGraph(plan.get_adjacency_list)
        return list(networkx.topological_sort(graph))
    raise UsageError(f"{plan.kind.name}: expected a sequential or a partial order plan")
