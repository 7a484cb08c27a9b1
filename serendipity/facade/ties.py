"""One answer from the answers for each of the human's optimal plans (semantics 1).

Figures are compared and added up as the search found them, exactly; only the result has floats.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Final, NamedTuple

from search import Outcome
from serendipity.model.result import Result

_A_FEW: Final = 4
"""Answers after which a bound on all of them costs less than it may save."""


class Answered(NamedTuple):
    """The answer to one of the human's plans, as the search and as callers see it."""

    outcome: Outcome
    result: Result


def until_settled(
    answers: Iterable[Answered], ties: str, *, bounded: bool, least: Callable[[], Fraction | None]
) -> Iterator[Answered]:
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
        found = answer.outcome
        dearest = found.cost is not None and found.cost == found.baseline
        # What the rest may cost at most has to be among the answers where the greatest cost counts.
        if _is_late(answer) and (ties != "robust" or found.cost is None or (bounded and dearest)):
            return
        if not bounded or found.status != "optimal":
            continue
        if number == _A_FEW and ties != "robust":
            floor = least()
        cheapest = found.cost == floor
        if {"robust": dearest, "optimistic": cheapest, "expected": dearest and cheapest}[ties]:
            return


def combined(
    answers: list[Answered],
    ties: str,
    *,
    bounded: bool = True,
    everyone: bool = True,
    limit: str | None = None,
) -> Result:
    """The answer under ``ties``; ``statistics["ties"]`` has those that it was made of.

    Where one of them has no plan, neither has the whole, unless that is for want of time and
    the least cost is wanted.

    Args:
        answers: at least one, as :func:`until_settled` gives them.
        ties: ``robust``, ``optimistic`` or ``expected``.
        bounded: whether each optimal plan has an answer at all, as without goals of the robots' own.
        everyone: whether there is an answer for each optimal plan.
        limit: the reason of an answer that is unknown since a limit came before everyone's.
    """
    listed = [
        {
            "human_plan": list(result.human_plan or ()),
            "cost": result.cost,
            "opportunity": result.opportunity,
            "realised": result.realised,
        }
        for _, result in answers
    ]
    chosen = _chosen(answers, ties, bounded=bounded, everyone=everyone, limit=limit)
    return replace(chosen, statistics={**chosen.statistics, "ties": listed})


def _chosen(
    answers: list[Answered], ties: str, *, bounded: bool, everyone: bool, limit: str | None
) -> Result:
    without = [answer.result for answer in answers if answer.outcome.cost is None]
    impossible = next((result for result in without if result.status == "infeasible"), None)
    if impossible is not None:
        return impossible
    planned = [answer for answer in answers if answer.outcome.cost is not None]
    if without and (ties != "optimistic" or not planned):
        return without[0]
    # What is not proved may yet cost less, or more: a smaller window may be worth it.
    late = any(map(_is_late, answers))
    if late and not bounded and (without or not everyone):  # one that is missing may have no plan
        return _unknown(answers[-1].result, limit)
    bounds = [answer.outcome.lower_bound or Fraction(0) for answer in answers]
    if ties != "expected":
        chosen = _extreme(planned, ties)
        lower_bound = min(bounds) if everyone else Fraction(0)
    elif everyone or not late:
        chosen = _mean([answer.outcome for answer in answers], answers[0].result)
        lower_bound = sum(bounds, Fraction(0)) / len(bounds)
    else:  # what the others cost is not known, so there is no mean
        return _unknown(answers[-1].result, limit)
    return replace(chosen, status="feasible", lower_bound=float(lower_bound)) if late else chosen


def _extreme(answers: list[Answered], ties: str) -> Result:
    """The answer of least (optimistic) or greatest (robust) cost; the first of equals."""
    extreme = min if ties == "optimistic" else max
    return extreme(answers, key=lambda answer: answer.outcome.cost or Fraction(0)).result


def _mean(outcomes: list[Outcome], first: Result) -> Result:
    """The expected answer: means of the figures, no single plan."""
    if len(outcomes) == 1:
        return first

    def mean(name: str) -> float | None:
        figures = [getattr(outcome, name) for outcome in outcomes]
        return None if None in figures else float(sum(figures, Fraction(0)) / len(figures))

    return replace(
        first,
        opportunity=any(outcome.opportunity for outcome in outcomes),
        cost=mean("cost"),
        saving=mean("saving"),  # of which there is none where doing nothing is no answer
        saving_alone=mean("saving_alone"),
        objective=mean("objective"),
        lower_bound=mean("lower_bound"),
        window=None,
        plan=None,
        agent_costs={},
        realised={},
    )


def _unknown(answer: Result, limit: str | None) -> Result:
    """An answer of which nothing is known but which plan of the human it is about."""
    return Result(
        answer.mode,
        "unknown",
        answer.human,
        answer.options,
        human_plan=answer.human_plan,
        human_cost=answer.human_cost,
        reason=limit,
        statistics=answer.statistics,
    )


def _is_late(answer: Answered) -> bool:
    """Whether a limit came before it was proved."""
    return answer.outcome.status in ("feasible", "unknown")
