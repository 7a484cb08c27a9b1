"""The engine ``serendipity`` of unified-planning."""

from collections.abc import Iterator
from typing import Any, Final

from unified_planning.engines import Credits, Engine, PlanGenerationResult, ValidationResult
from unified_planning.engines.mixins import AnytimePlannerMixin, OneshotPlannerMixin, PlanValidatorMixin
from unified_planning.engines.mixins.anytime_planner import AnytimeGuarantee
from unified_planning.engines.mixins.oneshot_planner import OptimalityGuarantee
from unified_planning.engines.results import FailedValidationReason, ValidationResultStatus
from unified_planning.exceptions import UPUsageError
from unified_planning.model import AbstractProblem, ProblemKind
from unified_planning.plans import Plan, PlanKind

from serendipity.model import SerendipityError, UsageError
from serendipity.up.answers import Answers, call_of
from serendipity.up.kinds import ENGINE, PLANS, supported_kind, with_metric
from serendipity.up.reading import read
from serendipity.up.validation import judged

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
        given = {"heuristic": heuristic, "output_stream": output_stream, "warm_start_plan": warm_start_plan}
        return Answers(problem, call, timeout, [name for name in given if given[name] is not None])

    def _validate(self, problem: AbstractProblem, plan: Plan) -> ValidationResult:
        try:
            verdict = judged(plan, read(problem, *self._call.who(problem)))
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
