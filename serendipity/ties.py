"""One answer from the answers for each of the human's optimal plans (SPEC 1)."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.model.result import Result

_A_FEW: Final = 4
"""Answers after which a bound on all of them costs less than it may save."""


def until_settled(
    answers: Iterable[Result], ties: str, *, bounded: bool, least: Callable[[], float | None]
) -> Iterator[Result]:
    """The answers one by one, until the rest can't make a difference, or a limit has come.

    Args:
        answers: one for each optimal plan, worked out when they are asked for.
        ties: ``robust``, ``optimistic`` or ``expected``.
        bounded: whether no answer costs more than ``pi_H``, as without goals of the robots' own.
        least: a lower bound on the cost of all answers, None where it is not known; asked for
            once, after a few of them.
    """
    floor: float | None = None
    for number, answer in enumerate(answers, start=1):
        yield answer
        dearest = answer.cost == answer.human_cost
        late = answer.status in ("feasible", "unknown")
        # What the rest may cost at most has to be among the answers where the greatest cost counts.
        if late and (ties != "robust" or answer.cost is None or (bounded and dearest)):
            return
        if not bounded or answer.status != "optimal":
            continue
        if number == _A_FEW and ties != "robust":
            floor = least()
        cheapest = answer.cost == floor
        if {"robust": dearest, "optimistic": cheapest, "expected": dearest and cheapest}[ties]:
            return


def combined(answers: list[Result], ties: str, *, everyone: bool = True) -> Result:
    """The answer under ``ties``; ``statistics["ties"]`` has those that it was made of.

    Args:
        answers: at least one.
        ties: ``robust``, ``optimistic`` or ``expected``.
        everyone: whether there is an answer for each optimal plan.
    """
    chosen = _mean(answers) if ties == "expected" else _extreme(answers, ties, everyone=everyone)
    listed = [
        {
            "human_plan": list(answer.human_plan or ()),
            "cost": answer.cost,
            "opportunity": answer.opportunity,
            "realised": answer.realised,
        }
        for answer in answers
    ]
    return replace(chosen, statistics={**chosen.statistics, "ties": listed})


def _extreme(answers: list[Result], ties: str, *, everyone: bool) -> Result:
    """The answer of least (optimistic) or greatest (robust) cost; the first of equals."""
    late = any(answer.status in ("feasible", "unknown") for answer in answers)
    if ties == "optimistic":  # where an answer is missing, the least cost is that of the others or less
        answers = [answer for answer in answers if answer.status != "unknown"] or answers
    sign = 1 if ties == "optimistic" else -1
    costs = [None if answer.cost is None else Fraction(str(answer.cost)) * sign for answer in answers]
    if None in costs:
        return answers[costs.index(None)]
    chosen = answers[min(range(len(answers)), key=lambda i: (costs[i], i))]
    if ties == "robust" or not late:
        return chosen
    # An answer that is not proved, or is missing, may yet turn out to cost less than the least.
    bounds = [answer.lower_bound for answer in answers if answer.lower_bound is not None]
    return replace(chosen, status="feasible", lower_bound=min(bounds) if everyone else 0.0)


def _mean(answers: list[Result]) -> Result:
    """The expected answer: means of the figures, no single plan."""
    first = answers[0]
    if any(answer.status != "optimal" for answer in answers):
        return next(answer for answer in answers if answer.status != "optimal")
    if len(answers) == 1:
        return first

    def mean(name: str) -> float:
        return float(sum(Fraction(str(getattr(answer, name) or 0)) for answer in answers) / len(answers))

    return replace(
        first,
        opportunity=any(answer.opportunity for answer in answers),
        cost=mean("cost"),
        saving=mean("saving"),
        objective=mean("objective"),
        lower_bound=mean("lower_bound"),
        window=None,
        plan=None,
        agent_costs={},
        realised={},
    )
