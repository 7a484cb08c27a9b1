"""Whether a plan is one: every order that it allows is executed."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import networkx
from unified_planning.plans import ActionInstance, Plan, PlanKind

from serendipity.model import GroundAction, Task
from serendipity.model.task.actions import apply
from serendipity.up.plans import depend, in_order
from serendipity.up.reading import Reading

_MOST: Final = 100_000
"""Sets of actions that are looked at, where their order matters."""


@dataclass(frozen=True, slots=True)
class PlanVerdict:
    """What is known of a plan.

    Attributes:
        valid: whether every order of it can be executed and reaches all goals; None if there are too many.
        cost: what it costs, if it is valid.
        at_fault: the action that is not applicable, in some order; None if it is the goals that are missed.
    """

    valid: bool | None
    cost: Fraction | None = None
    at_fault: ActionInstance | None = None


def judged(plan: Plan, reading: Reading) -> PlanVerdict:
    """Whether a plan is one of a problem.

    Raises:
        UsageError: it is of another kind, or has an action of another problem.
    """
    instances = in_order(plan)
    run = _PlanRun(reading, instances)
    verdict = run.in_turn()
    if verdict.valid and plan.kind == PlanKind.PARTIAL_ORDER_PLAN:
        return run.in_any_order(networkx.DiGraph(plan.get_adjacency_list), verdict)
    return verdict


class _PlanRun:
    """Executes the actions of a plan."""

    def __init__(self, reading: Reading, instances: list[ActionInstance]) -> None:
        self._task: Task = reading.task
        self._instances = instances
        self._names = {instance: reading.vocabulary.name_of(instance) for instance in instances}
        self._waiting = {name for name, _ in reading.task.waiting}
        self._chosen: dict[ActionInstance, GroundAction] = {}

    def in_turn(self) -> PlanVerdict:
        """One order."""
        state, cost = self._task.init, Fraction(0)
        for instance in self._instances:
            after = self._after(state, instance)
            if after is None:
                return PlanVerdict(False, at_fault=instance)
            state = after
            cost += self._chosen[instance].cost if instance in self._chosen else 0
        return PlanVerdict(True, cost) if self._reached(state) else PlanVerdict(False)

    def in_any_order(self, graph: "networkx.DiGraph[ActionInstance]", first: PlanVerdict) -> PlanVerdict:
        """All orders: those that differ by neighbours that may change places end alike."""
        follow = {node: networkx.descendants(graph, node) for node in graph}
        if not any(
            b not in follow[a] and a not in follow[b] and self._matters(a, b)
            for i, a in enumerate(self._instances)
            for b in self._instances[:i]
        ):
            return first
        return self._walked(graph, first)

    def _matters(self, a: ActionInstance, b: ActionInstance) -> bool:
        if a not in self._chosen or b not in self._chosen:
            return False
        variants = [self._variants(instance) for instance in (a, b)]
        return any(depend(x, y) for x in variants[0] for y in variants[1])

    def _walked(self, graph: "networkx.DiGraph[ActionInstance]", first: PlanVerdict) -> PlanVerdict:
        level: set[tuple[frozenset[ActionInstance], frozenset[int]]] = {(frozenset(), self._task.init)}
        seen = 0
        for _ in self._instances:
            following: set[tuple[frozenset[ActionInstance], frozenset[int]]] = set()
            for done, state in level:
                for instance in self._instances:
                    if instance in done or not done.issuperset(graph.predecessors(instance)):
                        continue
                    after = self._after(state, instance)
                    if after is None:
                        return PlanVerdict(False, at_fault=instance)
                    following.add((done | {instance}, after))
            seen += len(following)
            if seen > _MOST:
                return PlanVerdict(None)
            level = following
        return first if all(self._reached(state) for _, state in level) else PlanVerdict(False)

    def _after(self, state: frozenset[int], instance: ActionInstance) -> frozenset[int] | None:
        """The state after an action; None if it is not applicable."""
        for action in self._variants(instance):
            if action.applicable(state):
                self._chosen.setdefault(instance, action)
                return apply(state, action)
        return state if self._names[instance] in self._waiting else None

    def _variants(self, instance: ActionInstance) -> list[GroundAction]:
        ids = self._task.named.get(self._names[instance], ())
        return [self._task.actions[i] for i in ids]

    def _reached(self, state: frozenset[int]) -> bool:
        return self._task.goal.holds(state) and self._task.robot_goal.holds(state)
