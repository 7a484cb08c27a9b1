"""Puts an explanation together."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Final, TypeVar, Unpack

from serendipity.explanation.ask import PROVED, Ask, discount_threshold, parts_of, window_weight_threshold
from serendipity.explanation.explanation import TOLD, Explanation, misses, moments, removal_of
from serendipity.explanation.person import PlayedAnswer, Reaction
from serendipity.explanation.waiting import waits
from serendipity.explanation.wording import sentences
from serendipity.facade.call import options_from
from serendipity.facade.interruptibility import InterruptionReport, interruptions
from serendipity.model import Deadline, LimitReachedError, PlanError, Result, Task, UsageError
from serendipity.model.answers.over_scenarios import task_of
from serendipity.model.arguments import FUNCTION, RESULT_IN_TIME, TASK_IN_TIME, expect, expect_or_none
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.keywords import AnswerOptions, InterruptionOptions, listing
from serendipity.model.options import OF_SCENARIOS
from serendipity.model.resources.limits import limits_from
from serendipity.model.task.plans import PlanEntry, left_after
from serendipity.model.task.plans_in_time import times_of

_MODES: Final = ("serendipity", "communication", "composite")
_REPORTED: Final = tuple(InterruptionOptions.__annotations__)

T = TypeVar("T")

OnProgress = Callable[[int, int], None] | None


@listing
def explain(
    task: Task,
    result: Result | None = None,
    *,
    human_plan: Iterable[PlanEntry] | None = None,
    on_progress: OnProgress = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
    **options: Unpack[AnswerOptions],
) -> Explanation:
    """Why help comes as it does, or why there is none; each claim rests on a planning call.

    Where a limit comes first, topics are left out, and the explanation says which.

    Args:
        task: the task.
        result: an answer to explain; its options and human plan hold.  None plans first.
        human_plan: without ``result``: the human's plan, as for :func:`serendipity.plan`; None predicts it.
        on_progress: called while windows are examined: how many searches are done, and of how many.
        time_limit: seconds for the whole explanation, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares; it holds beside both limits.
        **options: without ``result``: those of :func:`serendipity.plan`.

    Raises:
        UsageError: both an answer and options, or an answer that has nothing to explain
            (individual and assistance mode), or one over several goals or plans.
        PlanError: ``human_plan`` can't be executed, or misses the goal.
        LimitReachedError: a limit came before there was any answer to explain.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(TASK_IN_TIME, task=task)
    expect_or_none(RESULT_IN_TIME, result=result)
    expect_or_none(FUNCTION, on_progress=on_progress)
    if result is not None and (options or human_plan is not None):
        raise UsageError("explain: expected a result or options, got both")
    if result is not None and len(result.goals or ()) > 1:
        raise UsageError("explain: an answer over several goals or plans is explained by explain_policy")
    task = task if result is None else task_of(task, result)
    asked = result.options.but(**OF_SCENARIOS) if result else options_from(options)
    chosen = asked.but(ties="fixed", time_limit=None, memory_limit=None)
    if chosen.mode not in _MODES:
        raise UsageError(f"explain: expected mode {', '.join(_MODES)}, got '{chosen.mode}'")
    ask = Ask(task, chosen, _entries(task, human_plan if result is None else _before(task, result)), limits)
    proved = result is not None and result.plan is not None and result.status == "optimal"
    answer = result if result is not None and proved else ask.attempt()
    if answer.status == "unknown":
        raise LimitReachedError(ask.limit_of(answer), "planning")
    return _explained(ask, answer, on_progress)


def _entries(task: Task, given: Iterable[PlanEntry] | None) -> tuple[PlanEntry, ...] | None:
    """A plan of the human's as it is given again: with epochs, where these say more than the order."""
    if given is None:
        return None
    plan = task.plan_from_names(given)
    names, times = tuple(task.actions[i].name for i in plan), times_of(task, plan)
    return names if times.plain else times.entries(names)


def _before(task: Task, result: Result) -> tuple[PlanEntry, ...] | None:
    """The human's plan of a result without its head start; None where only prediction knows one that fits."""
    entries, early = result.human_entries, result.options.head_start
    if entries is None or not early:
        return entries
    sooner = left_after(entries, early)
    try:
        task.plan_from_names(sooner)
    except PlanError:
        return None
    return sooner


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
    untold, replans = has_plan and options.mode == "serendipity", options.human_model != "omniscient"
    binds = bool(answer.statistics.get("rule_binds"))  # what windows could save knows of no rule
    windows = untold and not replans and not binds
    priced = has_plan and _has_thresholds(ask, answer)
    helpless = has_plan and not answer.opportunity
    early = answer.opportunity and bool(options.head_start)
    findings = _Findings(None if answer.status in PROVED else ask.limit_of(answer))
    reaction = _reaction(ask, answer, findings) if replans and answer.opportunity else None
    told = findings.about("announcement", lambda: ask(**TOLD), wanted=untold)
    at_once = findings.about("head_start", lambda: ask(head_start=0), wanted=early)
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
        waits=waits(ask.task, answer),
        at_once=at_once,
        reaction=reaction,
        epoch=ask.task.epoch if ask.task.needs_time or answer.in_time else None,
        limit=findings.limit,
        left_out=tuple(findings.left_out),
    )
    return replace(found, sentences=tuple(sentences(found)))


def _reaction(ask: Ask, answer: Result, findings: _Findings) -> Reaction | None:
    """What a human who replans makes of help; None where a limit came before anything was known of it."""
    played = PlayedAnswer(ask.task, answer, ask.deadline)
    turns = findings.about("person", played.turns, wanted=True)
    alone = findings.about("contrast", played.alone, wanted=True)
    contrasts = findings.about("contrast", played.contrasts, wanted=True)
    return None if turns is None else Reaction(turns, alone, contrasts or ())


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
