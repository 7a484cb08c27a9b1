"""Calls of an engine, who is who and which options, and results as its answers: statuses, plans, figures."""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from unified_planning.engines import LogLevel, LogMessage, PlanGenerationResult, PlanGenerationResultStatus
from unified_planning.exceptions import UPUsageError
from unified_planning.model import AbstractProblem, Problem
from unified_planning.model.multi_agent import MultiAgentProblem
from unified_planning.plans import Plan

from serendipity.facade.call import options_from
from serendipity.facade.planning import plan_anytime
from serendipity.model import INFINITE, Deadline, Options, Result
from serendipity.model.errors import InputError, LimitReachedError, PlanError, SerendipityError, UsageError
from serendipity.model.resources.limits import limits_from
from serendipity.model.task.plans import PlanEntry
from serendipity_up.kinds import ENGINE, with_metric
from serendipity_up.plans import human_plan_of, plan_of
from serendipity_up.predicting import predict
from serendipity_up.reading import ReadProblem, read

_HELP: Final = ("serendipity", "communication", "assistance")
_OWN: Final = ("human", "robots", "human_plan", "predict_with")


@dataclass(frozen=True, slots=True)
class EngineCall:
    """Parameters of the engine."""

    options: Options
    human: Any = None
    robots: Any = None
    human_plan: Plan | Iterable[str] | None = None
    predict_with: str | None = None
    given: tuple[tuple[str, Any], ...] = ()

    def but(self, changes: dict[str, Any]) -> "EngineCall":
        """The same with other parameters."""
        return call_of({**dict(self.given), **changes})

    @property
    def inexact(self) -> str | None:
        """The parameter for which an optimal plan need not be one of the problem; None if there is none."""
        options = self.options
        if options.mode != "composite":
            return f"mode '{options.mode}'"
        if options.horizon != INFINITE:
            return f"horizon {options.horizon}"
        if options.discount:
            return f"discount {options.discount}"
        return None if options.max_cost is None else f"max_cost {options.max_cost}"

    @property
    def exact(self) -> bool:
        """Whether an optimal plan is one of the problem."""
        return self.inexact is None

    @property
    def modeless(self) -> bool:
        """Whether nobody has asked for the best answer in a mode: any plan of the problem will do."""
        return self.exact and "mode" not in dict(self.given)

    def who(self, problem: AbstractProblem) -> tuple[Any, Any]:
        """Human and robots; a UsageError where nobody said who is helped, and that makes a difference."""
        mode = self.options.mode
        if self.human is None and self.robots is None and isinstance(problem, Problem) and mode in _HELP:
            raise UsageError(f"human: mode '{mode}' is help for somebody: expected an object")
        if self.human is None and self.exact and isinstance(problem, MultiAgentProblem) and problem.agents:
            return problem.agents[0].name, None
        return self.human, self.robots


def call_of(parameters: dict[str, Any]) -> EngineCall:
    """Parameters of the engine, checked."""
    own = {name: parameters[name] for name in _OWN if name in parameters}
    others: dict[str, Any] = {"mode": "composite", "interference": "strict"}
    others.update({name: value for name, value in parameters.items() if name not in own})
    if others["mode"] == "composite":
        others.setdefault("horizon", INFINITE)
    if own.get("human_plan") is not None and own.get("predict_with") is not None:
        raise UsageError("predict_with: the human's plan is given")
    try:
        options = options_from(others)
    except UsageError as error:
        message = str(error)
        if message.startswith("unknown option"):
            message = f"{message}, {', '.join(_OWN)}"
        raise UsageError(message) from None
    if options.mode == "assistance" or options.ties in ("watched", "expected"):
        what = "mode 'assistance'" if options.mode == "assistance" else f"ties '{options.ties}'"
        raise UsageError(f"{what}: the answer is no single plan, which is all that unified-planning has")
    return replace(EngineCall(options, **own), given=tuple(parameters.items()))


_FIGURES: Final = (
    *("cost", "objective", "lower_bound", "human_cost", "saving", "saving_alone", "opportunity"),
    *("horizon", "window", "reason", "realised", "status"),
)

Status = PlanGenerationResultStatus


class Answers:
    """The answers to one call, each better than those before it.

    Args:
        timeout: seconds, or None.
        ignored: what the caller gave that plays no part.
    """

    def __init__(
        self, problem: AbstractProblem, call: EngineCall, timeout: float | None, ignored: Sequence[str] = ()
    ) -> None:
        self._problem = problem
        self._call = call
        try:
            self._limits = limits_from(timeout, None)
        except UsageError as error:
            raise UPUsageError(f"{ENGINE}: {error}") from None
        self._messages = [LogMessage(LogLevel.WARNING, f"{name}: not used") for name in ignored]

    def all(self, *, any_plan: bool = False) -> Iterator[PlanGenerationResult]:
        """The answers; the last is final, and says so if the problem is not supported.

        Args:
            any_plan: the first plan is the last answer where neither the problem nor a mode says of one that
                it is better.

        Raises:
            UPUsageError: a parameter is wrong; it says which.
        """
        try:
            yield from self._planned(any_plan and self._call.modeless and not with_metric(self._problem))
        except LimitReachedError as error:
            status = Status.MEMOUT if error.reason == "memory-limit" else Status.TIMEOUT
            yield self._result(status, None, str(error))
        except SerendipityError as error:
            raise UPUsageError(f"{ENGINE}: {error}") from None

    def _planned(self, first: bool) -> Iterator[PlanGenerationResult]:
        options = self._call.options
        limits = limits_from(options.time_limit, options.memory_limit, self._limits)
        try:
            reading = read(self._problem, *self._call.who(self._problem), deadline=limits)
        except InputError as error:
            yield self._result(Status.UNSUPPORTED_PROBLEM, None, str(error))
            return
        names = self._human_plan(reading, limits)
        asked: dict[str, Any] = {name: getattr(options, name) for name in options.to_dict()}
        asked |= {"time_limit": None, "memory_limit": None}
        known: float | None = None
        last: Result | None = None
        for result in plan_anytime(reading.task, human_plan=names, deadline=limits, **asked):
            if first and result.cost is not None:
                yield self._answer(result, reading, self._status(result, reading))
                return
            if last is not None and last.cost is not None and (known is None or last.cost < known):
                known = last.cost
                yield self._answer(last, reading, Status.INTERMEDIATE)
            last = result
        if last is not None:
            yield self._answer(last, reading, self._status(last, reading))

    def _human_plan(self, reading: ReadProblem, limits: Deadline) -> tuple[PlanEntry, ...] | None:
        if self._call.human_plan is not None:
            return human_plan_of(self._call.human_plan, reading)
        if self._call.predict_with is not None:
            return predict(reading.task, self._call.predict_with, time_limit=limits.left())
        return None

    def _status(self, result: Result, reading: ReadProblem) -> PlanGenerationResultStatus:
        whole = self._call.exact and not reading.left_out and not reading.in_time
        match result.status:
            case "optimal" if whole and with_metric(self._problem):
                return Status.SOLVED_OPTIMALLY
            case "optimal" | "feasible":
                return Status.SOLVED_SATISFICING
            case "infeasible":
                return Status.UNSOLVABLE_PROVEN if whole else Status.UNSOLVABLE_INCOMPLETELY
        return Status.MEMOUT if result.reason == "memory-limit" else Status.TIMEOUT

    def _answer(
        self, result: Result, reading: ReadProblem, status: PlanGenerationResultStatus
    ) -> PlanGenerationResult:
        try:
            plan = plan_of(result, reading)
        except PlanError as error:
            if status is not Status.INTERMEDIATE:
                status = Status.UNSOLVABLE_INCOMPLETELY
            return self._result(status, None, str(error))
        figures = result.to_dict()
        told = {name: figures[name] for name in _FIGURES if figures[name] not in (None, {})}
        metrics = {name: json.dumps(of) if isinstance(of, dict) else str(of) for name, of in told.items()}
        metrics["engine_internal_time"] = str(self._limits.elapsed())
        notes = [*reading.task.warnings, *([] if result.reason is None else [result.reason])]
        return self._result(status, plan, *notes, metrics=metrics)

    def _result(
        self,
        status: PlanGenerationResultStatus,
        plan: object,
        *notes: str,
        metrics: dict[str, str] | None = None,
    ) -> PlanGenerationResult:
        messages = [*self._messages, *(LogMessage(LogLevel.INFO, note) for note in notes)]
        return PlanGenerationResult(status, plan, ENGINE, metrics, messages)
