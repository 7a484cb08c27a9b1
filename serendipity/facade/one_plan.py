"""Answers where it is settled which plan the human follows: the one that was given, or the canonical one."""

from collections.abc import Iterator
from typing import Any, Final

from search import solve
from serendipity.facade.call import Request
from serendipity.facade.simulation import realised
from serendipity.model import HumanPlan
from serendipity.model.answers.answer import Answer, Improvement
from serendipity.model.numbers import total
from serendipity.model.task.gate import is_bound, needs_time

_VERDICT_SHARE: Final = 0.02
"""The share of time that verdicts on humans who replan add to the limit, or take of the rest on the way."""


def answers(call: Request) -> Iterator[Answer]:
    """Answers as they get better, or their bounds do, each with how it came to be so good."""
    return _told(call, call.given)


def last_answer(call: Request, human_plan: HumanPlan) -> Answer:
    """The answer to one plan of the human's, with the verdicts on humans who replan."""
    *_, answer = _told(call, human_plan)
    return with_verdicts(call, answer._replace(human_plan=human_plan))  # which there was no time to find out


def with_verdicts(call: Request, answer: Answer, *, last: bool = True) -> Answer:
    """The answer with the verdicts of semantics 6, where they were not looked at yet; none without a plan.

    There are none in time and in mode ``assistance`` either.  They may go a little beyond the time limit, so
    that an answer at the limit has them too.  With an answer that is not the last one they take a small share
    of the time that is left, and may be missing.
    """
    if answer.realised is not None or answer.steps is None or answer.cost is None or not _has_verdicts(call):
        return answer
    verdicts = realised(
        call.prepared,
        call.options,
        answer.human_plan or (),
        answer.steps,
        cost=answer.cost - total(price for _, price in answer.left),
        horizon=answer.horizon,
        visible=call.visible,
        deadline=call.limits.sooner(-_VERDICT_SHARE) if last else call.limits.part(_VERDICT_SHARE),
    )
    return answer._replace(realised=verdicts)


def _has_verdicts(call: Request) -> bool:
    """Whether humans who replan are played in such a call: only epoch by epoch, and not in rounds."""
    in_time = needs_time(call.task, options=call.options, plan=call.given)
    return in_time is None and call.options.mode != "assistance"


def _planned(call: Request, human_plan: HumanPlan | None) -> Iterator[Answer]:
    """Answers beside a human of the model that is asked for, by the rule that nobody pays, where it holds."""
    if is_bound(call.original or call.task, call.options):
        from serendipity.facade import rules

        return rules.answers(call, human_plan, _without_rule)
    return _without_rule(call, human_plan)


def _without_rule(call: Request, human_plan: HumanPlan | None) -> Iterator[Answer]:
    asked: dict[str, Any] = {"human_plan": human_plan, "deadline": call.deadline, "warm": call.warm}
    if call.options.human_model == "omniscient":
        return solve(call.prepared, call.options, predicts=call.predicts, optimum=call.optimum, **asked)
    from search.modes.simulation.planner import solve_for_human

    return solve_for_human(call.prepared, call.options, visible=call.visible, **asked)


def _told(call: Request, human_plan: HumanPlan | None) -> Iterator[Answer]:
    gap: list[Improvement] = []
    for answer in _news(_planned(call, human_plan)):
        now = Improvement(call.deadline.elapsed(), answer.objective, answer.lower_bound)
        if not gap or gap[-1][1:] != now[1:]:
            gap.append(now)
        yield answer._replace(gap=tuple(gap))


def _news(answers: Iterator[Answer]) -> Iterator[Answer]:
    """The answers that say something new, and the last one."""
    said: tuple[object, ...] = ()
    repeated: Answer | None = None
    for answer in answers:
        says = (answer.status, answer.objective, answer.lower_bound)
        if says == said:
            repeated = answer
        else:
            said, repeated = says, None
            yield answer
    if repeated is not None:
        yield repeated
