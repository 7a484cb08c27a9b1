"""One answer from the answers for each of the human's optimal plans (semantics 1)."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from typing import Final

from search import FirstAnswer, PlanGraph, first_answer, least_over_ties, optimal_human_plans
from serendipity.facade import one_plan
from serendipity.facade.call import Request
from serendipity.model import Deadline, HumanPlan, Options, UsageError
from serendipity.model.answers.answer import Answer, Improvement
from serendipity.model.errors import LIMITS, limit_reason

_A_FEW: Final = 4
"""Answers after which a bound on all of them costs less than it may save."""


_SHARE: Final = 0.5
"""The share of the time that is left for all optimal plans together, where some plan is at hand."""


def answers(call: Request) -> Iterator[Answer]:
    """The answer over all optimal plans of the human's; with ``ties="fixed"`` those to one of them."""
    if call.options.ties == "fixed":
        yield from one_plan.answers(call)
    else:
        yield from _over_ties(call)


def _over_ties(call: Request) -> Iterator[Answer]:
    """Doing nothing beside a plan that is at hand; then the task solved for each optimal ``pi_H``.

    Raises:
        UsageError: there are more optimal plans than ``max_ties``.
    """
    try:
        known = first_answer(call.prepared, call.options, call.deadline)
    except LIMITS as limit:
        yield Answer("unknown", reason=limit_reason(limit), gap=())
        return
    for answer in known.answers():
        yield _by_itself(call, answer)
    late = call.deadline if known.plan is None else call.deadline.part(_SHARE)
    graph, why = _all_plans(call, late)
    if why is not None:
        yield _by_itself(call, _beside_one(call, known, why))
    elif graph is None:
        *_, answer = one_plan.answers(call)
        yield answer
    else:
        yield _beside_all(call, known, graph)


def _all_plans(call: Request, deadline: Deadline) -> tuple[PlanGraph | None, str | None]:
    """The human's optimal plans, None where there are none, or why they are not known.

    What the search held is free on return.
    """
    try:
        return optimal_human_plans(call.prepared, deadline), None
    except LIMITS as limit:
        return None, limit_reason(limit)


def _beside_one(call: Request, known: FirstAnswer, limit: str) -> Answer:
    """The answer beside one optimal plan, where not all are known and there is time; else doing nothing.

    The mean over all plans is no more than doing nothing, but may be more than any one of the answers.
    """
    if call.options.ties != "expected" and call.deadline.reached() is None:
        *_, answer = one_plan.answers(call)
        if answer.status in ("optimal", "feasible") and answer.saving_alone is not None:
            return answer._replace(status="feasible", lower_bound=known.least)
    return known.last(limit)


def _beside_all(call: Request, known: FirstAnswer, graph: PlanGraph) -> Answer:
    """The task solved once for each optimal ``pi_H``, as long as that makes a difference."""
    options = call.options
    count = graph.count()
    require_few(count, options)
    bounded = not call.task.robot_goal
    found = list(
        until_settled(
            map(partial(one_plan.last_answer, call), graph.plans()),
            options.ties,
            bounded=bounded,
            least=lambda: least_over_ties(call.prepared, options, graph, call.deadline),
        )
    )
    everyone = len(found) == count
    answer = combined(found, options.ties, bounded=bounded, everyone=everyone, limit=call.deadline.reached())
    if answer.status == "unknown":
        idle = known.beside(found[0].human_plan or ())
        if idle is not None:  # beside one of their best plans, so that they gain nothing alone
            answer = _by_itself(call, idle._replace(saving_alone=Fraction(0)))
    elif answer.status == "feasible":
        answer = answer._replace(lower_bound=max(known.least, answer.lower_bound or Fraction(0)))
    return answer._replace(optimal_plans=count)


def require_few(count: int, options: Options) -> None:
    """Check that the human has no more optimal plans than may be tried.

    Raises:
        UsageError: they have.
    """
    if count > options.max_ties:
        raise UsageError(
            f"max_ties: the human has {count} optimal plans, more than {options.max_ties}; "
            "raise max_ties, or use ties 'fixed'"
        )


def beside_each(call: Request, plans: Sequence[HumanPlan], ties: str) -> Answer:
    """The answer over optimal plans that are known, as long as they make a difference.

    Args:
        plans: all of them.
        ties: ``robust``, ``optimistic`` or ``expected``.
    """
    bounded = not call.task.robot_goal
    each = map(partial(one_plan.last_answer, call), plans)
    found = list(until_settled(each, ties, bounded=bounded, least=lambda: None))
    everyone, limit = len(found) == len(plans), call.deadline.reached()
    answer = combined(found, ties, bounded=bounded, everyone=everyone, limit=limit)
    return answer._replace(optimal_plans=len(plans))


def _by_itself(call: Request, answer: Answer) -> Answer:
    """An answer over ties that is made of itself, since those to other plans are not known."""
    if answer.gap is None:
        now = Improvement(call.deadline.elapsed(), answer.objective, answer.lower_bound)
        answer = answer._replace(gap=() if answer.cost is None else (now,))
    return answer if answer.cost is None else answer._replace(ties=(answer,))


def until_settled(
    answers: Iterable[Answer], ties: str, *, bounded: bool, least: Callable[[], Fraction | None]
) -> Iterator[Answer]:
    """The answers one by one, until the rest can't make a difference, or a limit has come.

    Args:
        answers: one for each optimal plan, worked out when they are asked for.
        ties: ``robust``, ``optimistic`` or ``expected``.
        bounded: whether no answer costs more than ``pi_H``, as without goals of the robots' own.
        least: a lower bound on the cost of all answers, None where it is not known; asked for
            once, after a few of them.
    """
    floor: Fraction | None = None
    for number, answer in enumerate(answers, start=1):
        yield answer
        dearest = answer.cost is not None and answer.cost == answer.baseline
        # What the rest may cost at most has to be among the answers where the greatest cost counts.
        if _is_late(answer) and (ties != "robust" or answer.cost is None or (bounded and dearest)):
            return
        if not bounded or answer.status != "optimal":
            continue
        if number == _A_FEW and ties != "robust":
            floor = least()
        cheapest = answer.cost == floor
        if {"robust": dearest, "optimistic": cheapest, "expected": dearest and cheapest}[ties]:
            return


def combined(
    answers: list[Answer], ties: str, *, bounded: bool = True, everyone: bool = True, limit: str | None = None
) -> Answer:
    """The answer under ``ties``, and those that it was made of.

    Where one of them has no plan, neither has the whole, unless that is for want of time and
    the least cost is wanted.

    Args:
        answers: at least one, as :func:`until_settled` gives them.
        ties: ``robust``, ``optimistic`` or ``expected``.
        bounded: whether each optimal plan has an answer at all, as without goals of the robots' own.
        everyone: whether there is an answer for each optimal plan.
        limit: the reason of an answer that is unknown since a limit came before everyone's.
    """
    chosen = _chosen(answers, ties, bounded=bounded, everyone=everyone, limit=limit)
    return chosen._replace(ties=tuple(answers))


def _chosen(answers: list[Answer], ties: str, *, bounded: bool, everyone: bool, limit: str | None) -> Answer:
    without = [answer for answer in answers if answer.cost is None]
    impossible = next((answer for answer in without if answer.status == "infeasible"), None)
    if impossible is not None:
        return impossible
    planned = [answer for answer in answers if answer.cost is not None]
    if without and (ties != "optimistic" or not planned):
        return without[0]
    # What is not proved may yet cost less, or more: a smaller window may be worth it.
    late = any(map(_is_late, answers))
    if late and not bounded and (without or not everyone):  # one that is missing may have no plan
        return _unknown(answers[-1], limit)
    bounds = [answer.lower_bound or Fraction(0) for answer in answers]
    if ties != "expected":
        chosen = _extreme(planned, ties)
        lower_bound = min(bounds) if everyone else Fraction(0)
    elif everyone or not late:
        chosen = _mean(answers)
        lower_bound = sum(bounds, Fraction(0)) / len(bounds)
    else:  # what the others cost is not known, so there is no mean
        return _unknown(answers[-1], limit)
    return chosen._replace(status="feasible", lower_bound=lower_bound) if late else chosen


def _extreme(answers: list[Answer], ties: str) -> Answer:
    """The answer of least (optimistic) or greatest (robust) cost; the first of equals."""
    extreme = min if ties == "optimistic" else max
    return extreme(answers, key=lambda answer: answer.cost or Fraction(0))


def _mean(answers: list[Answer]) -> Answer:
    """The expected answer: means of the figures, no single plan."""
    first = answers[0]
    if len(answers) == 1:
        return first

    def mean(figures: list[Fraction | None]) -> Fraction | None:
        known = [figure for figure in figures if figure is not None]
        return sum(known, Fraction(0)) / len(known) if len(known) == len(figures) else None

    return first._replace(
        opportunity=any(answer.opportunity for answer in answers),
        cost=mean([answer.cost for answer in answers]),
        saving=mean([answer.saving for answer in answers]),  # none where doing nothing is no answer
        saving_alone=mean([answer.saving_alone for answer in answers]),
        objective=mean([answer.objective for answer in answers]),
        lower_bound=mean([answer.lower_bound for answer in answers]),
        window=None,
        steps=None,
        realised={},
    )


def _unknown(answer: Answer, limit: str | None) -> Answer:
    """An answer of which nothing is known but which plan of the human it is about."""
    return Answer(
        "unknown",
        human_plan=answer.human_plan,
        reason=limit,
        expanded=answer.expanded,
        generated=answer.generated,
        gap=answer.gap,
    )


def _is_late(answer: Answer) -> bool:
    """Whether a limit came before it was proved."""
    return answer.status in ("feasible", "unknown")
