"""Rules on answers that speak for all of the human's optimal plans at once (semantics 1, ``ties``)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from serendipity.model import Result
from verify.base.obligations import is_mean, is_tied
from verify.rules.case import Case, Found


@dataclass(frozen=True, slots=True)
class TiedAnswer:
    """What the result says of one optimal ``pi_H``."""

    human_plan: tuple[str, ...]
    cost: float | None
    opportunity: bool


class MalformedTiesError(Exception):
    """``statistics.ties`` is missing, or not of the form that it has."""


def tied_answers(result: Result) -> tuple[TiedAnswer, ...]:
    """The answers that a result was made of.

    Raises:
        MalformedTiesError: saying what is wrong with them.
    """
    listed = result.statistics.get("ties")
    if not isinstance(listed, list | tuple) or not listed:
        raise MalformedTiesError("statistics.ties does not list the answers for his optimal plans")
    return tuple(map(_answer, listed))


def ties(case: Case) -> Found | None:
    """The answers that an answer over ties is made of are listed, its own among them; no others are."""
    result = case.result
    if not is_tied(result):
        return Found("answers over ties, without ties") if "ties" in result.statistics else None
    if result.status not in ("optimal", "feasible"):
        return None
    try:
        answers = tied_answers(result)
    except MalformedTiesError as error:
        return Found(str(error))
    if is_mean(result):
        return None
    own = (result.human_plan, result.cost, result.opportunity)
    if own not in [(answer.human_plan, answer.cost, answer.opportunity) for answer in answers]:
        return Found("the answer is none of those that statistics.ties lists")
    return None


def mean(case: Case) -> Found | None:
    """``expected``: the cost is the mean of the answers, which the solved ones prove to the last digit."""
    result = case.result
    if not is_mean(result):
        return None
    answers = tied_answers(result)  # whose form is a rule before this one
    if len(answers) < 2 or result.cost is None or any(answer.cost is None for answer in answers):
        return Found("a mean without the answers that it is the mean of (statistics.ties)")
    if result.opportunity != any(answer.opportunity for answer in answers):
        return Found("there is an opportunity if there is one for some pi_H")
    right = math.fsum(answer.cost or 0 for answer in answers) / len(answers)
    if not math.isclose(result.cost, right, rel_tol=1e-12):
        return Found(f"cost is {right:.12g}, the result says {result.cost:.12g}")
    return None


def _answer(entry: Any) -> TiedAnswer:
    if not isinstance(entry, Mapping):
        raise MalformedTiesError("statistics.ties: expected an object for each answer")
    plan, cost, opportunity = (entry.get(key) for key in ("human_plan", "cost", "opportunity"))
    if not isinstance(plan, list | tuple) or not all(isinstance(name, str) for name in plan):
        raise MalformedTiesError("statistics.ties: expected human_plan to be a list of actions")
    number = isinstance(cost, int | float) and not isinstance(cost, bool) and math.isfinite(cost)
    if "cost" not in entry or not (number or cost is None):
        raise MalformedTiesError("statistics.ties: expected cost to be a number or null")
    if not isinstance(opportunity, bool):
        raise MalformedTiesError("statistics.ties: expected opportunity to be true or false")
    return TiedAnswer(tuple(plan), cost, opportunity)
