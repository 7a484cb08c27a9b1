"""The engine ``serendipity`` of unified-planning: a planner, and a validator that tries every order."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import networkx
from unified_planning.engines import Credits, Engine, PlanGenerationResult, ValidationResult
from unified_planning.engines.mixins import AnytimePlannerMixin, OneshotPlannerMixin, PlanValidatorMixin
from unified_planning.engines.mixins.anytime_planner import AnytimeGuarantee
from unified_planning.engines.mixins.oneshot_planner import OptimalityGuarantee
from unified_planning.engines.results import FailedValidationReason, ValidationResultStatus
from unified_planning.exceptions import UPUsageError
from unified_planning.model import AbstractProblem, ProblemKind
from unified_planning.plans import ActionInstance, Plan, PlanKind

from serendipity.model import GroundAction, SerendipityError, Task, UsageError
from serendipity.model.task.actions import apply
from serendipity_up.answers import Answers, call_of
from serendipity_up.kinds import ENGINE, PLANS, in_time, supported_kind, with_metric
from serendipity_up.plans import depend, in_order
from serendipity_up.reading import ReadProblem, read

_MOST: Final = 100_000
"""Sets of actions that are looked at, where their order matters."""


@dataclass(frozen=True, slots=True)
class PlanVerdict:
    """What is known of a plan.

    Attributes:
        valid: whether every order of it can be executed and reaches all goals; None if there are too many.
        at_fault: the action that is not applicable, in some order; None if it is the goals that are missed.
    """

    valid: bool | None
    cost: Fraction | None = None
    at_fault: ActionInstance | None = None


def judged(plan: Plan, reading: ReadProblem) -> PlanVerdict:
    """Whether a plan is one of a problem."""
    instances = in_order(plan)
    run = _PlanRun(reading, instances)
    verdict = run.in_turn()
    if verdict.valid and plan.kind == PlanKind.PARTIAL_ORDER_PLAN:
        return run.in_any_order(networkx.DiGraph(plan.get_adjacency_list), verdict)
    return verdict


class _PlanRun:
    """Executes the actions of a plan."""

    def __init__(self, reading: ReadProblem, instances: list[ActionInstance]) -> None:
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


_CREDITS: Final = Credits(
    "Serendipity",
    "Serendipity maintainers",
    "",
    "",
    "MIT",
    "Plans help for a person who did not ask for it.",
    "Plans help for a person who did not ask for it, and proves that none is better; plans for teams.",
)


class SerendipityEngine(Engine, OneshotPlannerMixin, AnytimePlannerMixin, PlanValidatorMixin):
    """Composite plans of all agents, help for one of them, and a validator for both.

    Args:
        **parameters: ``human``, ``robots``, ``human_plan`` (a plan or names), ``predict_with`` (an
            engine), and the options of :func:`serendipity.plan`.  Without a mode it is ``composite``
            with ``horizon="inf"``, and without an interference it is ``strict``.

    Raises:
        UPUsageError: a parameter is unknown or has no legal value.
    """

    def __init__(self, **parameters: Any) -> None:
        Engine.__init__(self)
        OneshotPlannerMixin.__init__(self)
        AnytimePlannerMixin.__init__(self)
        try:
            self._call = call_of(parameters)
        except UsageError as error:
            raise UPUsageError(f"{ENGINE}: {error}") from None

    @property
    def name(self) -> str:
        """The name in the factory."""
        return ENGINE

    @staticmethod
    def get_credits(**parameters: Any) -> Credits | None:  # noqa: ARG004
        """Who made it."""
        return _CREDITS

    @staticmethod
    def supported_kind() -> ProblemKind:
        """What problems may have."""
        return supported_kind()

    @staticmethod
    def supports(problem_kind: ProblemKind) -> bool:
        """Whether problems of a kind are understood."""
        return bool(problem_kind <= supported_kind())

    @staticmethod
    def supports_plan(plan_kind: PlanKind) -> bool:
        """Whether plans of a kind are validated."""
        return plan_kind in PLANS

    @staticmethod
    def satisfies(optimality_guarantee: OptimalityGuarantee) -> bool:
        """All: without parameters, plans are optimal; with those of help, nothing is promised but help."""
        return optimality_guarantee in OptimalityGuarantee

    @staticmethod
    def ensures(anytime_guarantee: AnytimeGuarantee) -> bool:
        """Plans get better; not all of them are optimal."""
        return bool(anytime_guarantee == AnytimeGuarantee.INCREASING_QUALITY)

    def _solve(self, problem: AbstractProblem, *given: Any, **more: Any) -> PlanGenerationResult:
        *_, last = self._answers(problem, *given, **more).all(any_plan=not self.optimality_metric_required)
        return last

    _solve_with_params = _solve

    def _get_solutions(
        self, problem: AbstractProblem, timeout: float | None = None, *given: Any, **more: Any
    ) -> Iterator[PlanGenerationResult]:
        yield from self._answers(problem, None, timeout, **more).all()

    _get_solutions_with_params = _get_solutions

    def _answers(
        self,
        problem: AbstractProblem,
        heuristic: object = None,
        timeout: float | None = None,
        output_stream: object = None,
        warm_start_plan: Plan | None = None,
        **more: Any,
    ) -> Answers:
        call = self._call if not more else self._call.but(more)
        if self.optimality_metric_required and not call.exact:
            raise UPUsageError(f"{ENGINE}: {call.inexact}: then plans are not optimal for the problem")
        if self.optimality_metric_required and in_time(problem):
            raise UPUsageError(f"{ENGINE}: plans in time are optimal among those in whole epochs only")
        given = {"heuristic": heuristic, "output_stream": output_stream, "warm_start_plan": warm_start_plan}
        return Answers(problem, call, timeout, [name for name in given if given[name] is not None])

    def _validate(self, problem: AbstractProblem, plan: Plan) -> ValidationResult:
        try:
            reading = read(problem, *self._call.who(problem))
            if reading.in_time:
                raise UsageError("plans in time are validated by 'time_triggered_plan_validator'")
            verdict = judged(plan, reading)
        except SerendipityError as error:
            raise UPUsageError(f"{ENGINE}: {error}") from None
        if verdict.valid is None:
            return ValidationResult(ValidationResultStatus.UNKNOWN, ENGINE)
        if verdict.valid:
            costs = {problem.quality_metrics[0]: verdict.cost} if with_metric(problem) else None
            return ValidationResult(ValidationResultStatus.VALID, ENGINE, metric_evaluations=costs)
        missed = verdict.at_fault is None
        return ValidationResult(
            ValidationResultStatus.INVALID,
            ENGINE,
            reason=FailedValidationReason.UNSATISFIED_GOALS
            if missed
            else FailedValidationReason.INAPPLICABLE_ACTION,
            inapplicable_action=verdict.at_fault,
        )
