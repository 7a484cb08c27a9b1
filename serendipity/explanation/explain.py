"""Puts an explanation together."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, Final

from serendipity.explanation.ask import Ask, Parts, parts_of
from serendipity.explanation.break_even import Threshold, discount_threshold, window_weight_threshold
from serendipity.explanation.misses import Miss, misses, removal_of
from serendipity.explanation.moments import Moment, moments
from serendipity.explanation.wording import sentences
from serendipity.interruptibility import InterruptionReport, Removal, interruptions
from serendipity.model import Result, Task, UsageError
from serendipity.planning import options_from

SCHEMA: Final = "serendipity.explanation/1"
_MODES: Final = ("serendipity", "communication", "composite")
_REPORTED: Final = ("discount", "horizon", "suffix", "preservation", "interference")

OnProgress = Callable[[int, int], None] | None


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why an answer is what it is.

    Attributes:
        answer: what is explained.
        removal: what disappears from his plan and what replaces it; None without help.
        parts: what the answer's plan costs; None without a plan.
        moments: each start of the window; empty where windows play no part.
        discount: where help begins to pay; None where that is not computed.
        window_weight: the greatest ``K`` at which longer interruptions help; None where not computed.
        announcement: the answer in communication mode, or None.
        misses: what would help if a rule were relaxed; empty where a robot helps anyway.
        sentences: all of it in words, topic by topic.
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

    def to_dict(self) -> dict[str, Any]:
        """The JSON object (schema ``serendipity.explanation/1``)."""
        answer, gone, told = self.answer, self.removal, self.announcement
        return {
            "schema": SCHEMA,
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
    **options: Any,
) -> Explanation:
    """Why help comes as it does, or why there is none; each claim rests on a planning call.

    Args:
        task: the task.
        result: an answer to explain; its options and human plan hold.  None plans first.
        human_plan: without ``result``: what the human is going to do; None predicts it.
        on_progress: called while windows are examined: how many searches are done, and of how many.
        **options: without ``result``: those of :func:`serendipity.plan`.

    Raises:
        UsageError: both an answer and options, or an answer that has nothing to explain
            (individual and assistance mode, human models).
        PlanError: ``human_plan`` can't be executed, or misses the goal.
    """
    if result is not None and (options or human_plan is not None):
        raise UsageError("explain: expected a result or options, got both")
    chosen = (result.options if result else options_from(options)).but(ties="fixed", time_limit=None)
    if chosen.mode not in _MODES or chosen.human_model != "omniscient":
        raise UsageError(
            f"explain: expected mode {', '.join(_MODES)} and human model 'omniscient', "
            f"got '{chosen.mode}' and '{chosen.human_model}'"
        )
    given = _given(task, result, human_plan)
    ask = Ask(task, chosen, given)
    proved = result is not None and result.plan is not None and result.status == "optimal"
    return _explained(ask, result if result is not None and proved else ask(), on_progress)


def _given(task: Task, result: Result | None, human_plan: Iterable[str] | None) -> tuple[str, ...] | None:
    names = result.human_plan if result is not None else human_plan
    return None if names is None else tuple(task.actions[i].name for i in task.plan_from_names(names))


def _explained(ask: Ask, answer: Result, on_progress: OnProgress) -> Explanation:
    options, has_plan = ask.options, answer.human_plan is not None
    priced = has_plan and _has_thresholds(ask, answer)
    report = _report(ask, on_progress) if has_plan and options.mode == "serendipity" else None
    told = None
    if has_plan and options.mode == "serendipity":
        told = ask(mode="communication", keep_prefix=False)
    weight = None
    if priced and report is not None and not answer.opportunity and options.max_window is None:
        weight = window_weight_threshold(ask, report)
    found = Explanation(
        answer=answer,
        removal=removal_of(answer) if answer.opportunity else None,
        parts=parts_of(ask.task, answer) if answer.plan is not None else None,
        moments=() if report is None else moments(report, answer),
        discount=discount_threshold(ask) if priced else None,
        window_weight=weight,
        announcement=told,
        misses=() if answer.opportunity or not has_plan else misses(ask, report),
    )
    return replace(found, sentences=tuple(sentences(found)))


def _has_thresholds(ask: Ask, answer: Result) -> bool:
    """Whether "doing nothing" has a fixed price, and price is all that stops a plan.

    Not with goals of the robots' own, a plan that he can improve alone, or a limit on cost.
    """
    limited = ask.options.max_cost not in (None, "human")
    return not (ask.task.robot_goal or answer.saving_alone or limited)


def _report(ask: Ask, on_progress: OnProgress) -> InterruptionReport:
    asked = {name: getattr(ask.options, name) for name in _REPORTED}
    return interruptions(ask.task, human_plan=ask.human_plan, on_progress=on_progress, **asked)
