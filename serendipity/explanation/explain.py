"""Puts an explanation together."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, Final, TypeVar

from serendipity.explanation.ask import PROVED, Ask, Parts, parts_of
from serendipity.explanation.break_even import Threshold, discount_threshold, window_weight_threshold
from serendipity.explanation.misses import Miss, misses, removal_of
from serendipity.explanation.moments import Moment, moments
from serendipity.explanation.wording import sentences
from serendipity.facade.interruptibility import InterruptionReport, Removal, interruptions
from serendipity.facade.planning import options_from
from serendipity.model import Deadline, LimitReachedError, Result, Task, UsageError
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.limits import limits_from

SCHEMA: Final = "serendipity.explanation/1"
_MODES: Final = ("serendipity", "communication", "composite")
_REPORTED: Final = ("discount", "horizon", "suffix", "preservation", "interference")

T = TypeVar("T")

OnProgress = Callable[[int, int], None] | None


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why an answer is what it is.

    Attributes:
        answer: what is explained.
        removal: what disappears from the human's plan and what replaces it; None without help.
        parts: what the answer's plan costs; None without a plan.
        moments: each start of the window; empty where windows play no part.
        discount: where help begins to pay; None where that is not computed.
        window_weight: the greatest ``K`` at which longer interruptions help; None where not computed.
        announcement: the answer in communication mode, or None.
        misses: what would help if a rule were relaxed; empty where a robot helps anyway.
        sentences: all of it in words, topic by topic.
        limit: which limit came before everything was found out (as ``Result.reason`` has it), or None.
        left_out: what is missing for it: ``moment``, ``discount``, ``window_weight``,
            ``announcement``, ``miss``.
    """

    answer: Result
    removal: Removal | None
    parts: Parts | None
    moments: tuple[Moment, ...]
    discount: Threshold | None
    window_weight: Threshold | None
    announcement: Result | None
    misses: tuple[Miss, ...]
    sentences: tuple[tuple[str, str], ...] = ()
    limit: str | None = None
    left_out: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether nothing is missing for want of time or memory."""
        return self.limit is None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object (schema ``serendipity.explanation/1``)."""
        answer, gone, told = self.answer, self.removal, self.announcement
        return {
            "schema": SCHEMA,
            "complete": self.complete,
            "limit": self.limit,
            "left_out": list(self.left_out),
            "mode": answer.mode,
            "opportunity": answer.opportunity,
            "human_cost": answer.human_cost,
            "cost": answer.cost,
            "saving": answer.saving,
            "reason": answer.reason,
            "removed": None if gone is None else list(gone.removed),
            "removed_first": None if gone is None else gone.first,
            "removed_last": None if gone is None else gone.last,
            "replacement": None if gone is None else list(gone.replacement),
            "human_part": None if self.parts is None else float(self.parts.human),
            "robot_part": None if self.parts is None else float(self.parts.discounted(answer.options)),
            "moments": [moment.to_dict() for moment in self.moments],
            "break_even_discount": None if self.discount is None else self.discount.to_dict(),
            "break_even_window_weight": None if self.window_weight is None else self.window_weight.to_dict(),
            "announcement": None if told is None else {"cost": told.cost, "opportunity": told.opportunity},
            "misses": [miss.to_dict() for miss in self.misses],
            "sentences": [{"topic": topic, "text": text} for topic, text in self.sentences],
            "options": answer.options.to_dict(),
        }


def explain(
    task: Task,
    result: Result | None = None,
    *,
    human_plan: Iterable[str] | None = None,
    on_progress: OnProgress = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
    **options: Any,
) -> Explanation:
    """Why help comes as it does, or why there is none; each claim rests on a planning call.

    Where a limit comes first, topics are left out, and the explanation says which.

    Args:
        task: the task.
        result: an answer to explain; its options and human plan hold.  None plans first.
        human_plan: without ``result``: what the human is going to do; None predicts it.
        on_progress: called while windows are examined: how many searches are done, and of how many.
        time_limit: seconds for the whole explanation, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares; it holds beside both limits.
        **options: without ``result``: those of :func:`serendipity.plan`.

    Raises:
        UsageError: both an answer and options, or an answer that has nothing to explain
            (individual and assistance mode, human models).
        PlanError: ``human_plan`` can't be executed, or misses the goal.
        LimitReachedError: a limit came before there was any answer to explain.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    if result is not None and (options or human_plan is not None):
        raise UsageError("explain: expected a result or options, got both")
    asked = result.options if result else options_from(options)
    chosen = asked.but(ties="fixed", time_limit=None, memory_limit=None)
    if chosen.mode not in _MODES or chosen.human_model != "omniscient":
        raise UsageError(
            f"explain: expected mode {', '.join(_MODES)} and human model 'omniscient', "
            f"got '{chosen.mode}' and '{chosen.human_model}'"
        )
    given = _given(task, result, human_plan)
    ask = Ask(task, chosen, given, limits)
    proved = result is not None and result.plan is not None and result.status == "optimal"
    answer = result if result is not None and proved else ask.attempt()
    if answer.status == "unknown":
        raise LimitReachedError(ask.limit_of(answer), "planning")
    return _explained(ask, answer, on_progress)


def _given(task: Task, result: Result | None, human_plan: Iterable[str] | None) -> tuple[str, ...] | None:
    names = result.human_plan if result is not None else human_plan
    return None if names is None else tuple(task.actions[i].name for i in task.plan_from_names(names))


class _Findings:
    """Finds out topic by topic, until a limit comes."""

    def __init__(self, limit: str | None) -> None:
        self.limit = limit
        self.left_out: list[str] = []

    def about(self, topic: str, find: Callable[[], T], *, wanted: bool) -> T | None:
        """What ``find`` returns; None where it is not wanted, or a limit has come."""
        if not wanted:
            return None
        if self.limit is None:
            try:
                return find()
            except LIMITS as error:
                self.limit = limit_reason(error)
        if topic not in self.left_out:
            self.left_out.append(topic)
        return None


def _explained(ask: Ask, answer: Result, on_progress: OnProgress) -> Explanation:
    """Everything about an answer; the windows, of which there are many, come last."""
    options, has_plan = ask.options, answer.human_plan is not None
    windows = has_plan and options.mode == "serendipity"
    priced = has_plan and _has_thresholds(ask, answer)
    helpless = has_plan and not answer.opportunity
    findings = _Findings(None if answer.status in PROVED else ask.limit_of(answer))
    told = findings.about(
        "announcement", lambda: ask(mode="communication", keep_prefix=False), wanted=windows
    )
    discount = findings.about("discount", lambda: discount_threshold(ask), wanted=priced)
    missed = findings.about("miss", lambda: misses(ask, None), wanted=helpless)
    report = findings.about("moment", lambda: _report(ask, on_progress), wanted=windows)
    if missed is not None and report is not None:
        missed = misses(ask, report)  # the same answers, now with the shortest windows
    longer = windows and priced and helpless and options.max_window is None
    weight = findings.about("window_weight", lambda: window_weight_threshold(ask, report), wanted=longer)
    found = Explanation(
        answer=answer,
        removal=removal_of(answer) if answer.opportunity else None,
        parts=parts_of(ask.task, answer) if answer.plan is not None else None,
        moments=() if report is None else moments(report, answer),
        discount=discount,
        window_weight=weight,
        announcement=told,
        misses=missed or (),
        limit=findings.limit,
        left_out=tuple(findings.left_out),
    )
    return replace(found, sentences=tuple(sentences(found)))


def _has_thresholds(ask: Ask, answer: Result) -> bool:
    """Whether "doing nothing" has a fixed price, and price is all that stops a plan.

    Not with goals of the robots' own, a plan that the human can improve alone, or a limit on cost.
    """
    limited = ask.options.max_cost not in (None, "human")
    return not (ask.task.robot_goal or answer.saving_alone or limited)


def _report(ask: Ask, on_progress: OnProgress) -> InterruptionReport:
    """Every window: what is so of some of them says little of the rest."""
    asked = {name: getattr(ask.options, name) for name in _REPORTED}
    report = interruptions(
        ask.task, human_plan=ask.human_plan, on_progress=on_progress, deadline=ask.deadline, **asked
    )
    if report.limit is not None:
        raise LimitReachedError(report.limit)
    return report
