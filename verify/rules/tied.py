"""Rules on answers that speak for all of the human's optimal plans at once (semantics 1, ``ties``)."""

import math

from serendipity.model import Result
from serendipity.model.answers.fields import MalformedError
from serendipity.model.answers.result_parts import TiedAnswer
from verify.base.obligations import is_mean, is_tied
from verify.rules.case import CheckedResult, RuleFault


def tied_answers(result: Result) -> tuple[TiedAnswer, ...]:
    """The answers that a result was made of.

    Raises:
        MalformedError: saying what is wrong with them.
    """
    if not result.ties:
        missing = "statistics.ties does not list the answers for his optimal plans"
        raise MalformedError(result.malformed.get("ties", missing))
    return result.ties


def ties(case: CheckedResult) -> RuleFault | None:
    """The answers that an answer over ties is made of are listed, its own among them; no others are."""
    result = case.result
    if not is_tied(result):
        return RuleFault("answers over ties, without ties") if result.says("ties") else None
    if result.status not in ("optimal", "feasible"):
        return None
    try:
        answers = tied_answers(result)
    except MalformedError as error:
        return RuleFault(str(error))
    if len({answer.human_plan for answer in answers}) < len(answers):
        return RuleFault("statistics.ties lists two answers for one plan of the human")
    if is_mean(result):
        return None
    own = (result.human_plan, result.cost, result.opportunity)
    if own not in [(answer.human_plan, answer.cost, answer.opportunity) for answer in answers]:
        return RuleFault("the answer is none of those that statistics.ties lists")
    return _extreme(case, [answer.cost for answer in answers])


def _extreme(case: CheckedResult, costs: list[float | None]) -> RuleFault | None:
    """``robust`` is the dearest of the answers, each of which has a plan, ``optimistic`` the cheapest."""
    ties, known = case.result.options.ties, [cost for cost in costs if cost is not None]
    if ties == "robust" and (len(known) < len(costs) or case.result.cost != max(known)):
        return RuleFault("robust: the answer is not the dearest of those that statistics.ties lists")
    if ties == "optimistic" and case.result.cost != min(known):
        return RuleFault("optimistic: the answer is not the cheapest of those that statistics.ties lists")
    return None


def mean(case: CheckedResult) -> RuleFault | None:
    """``expected``: the cost is the mean of the answers, which the solved ones prove to the last digit."""
    result = case.result
    if not is_mean(result):
        return None
    answers = tied_answers(result)  # whose form is a rule before this one
    if len(answers) < 2 or result.cost is None or any(answer.cost is None for answer in answers):
        return RuleFault("a mean without the answers that it is the mean of (statistics.ties)")
    if result.opportunity != any(answer.opportunity for answer in answers):
        return RuleFault("there is an opportunity if there is one for some pi_H")
    right = math.fsum(answer.cost or 0 for answer in answers) / len(answers)
    if not math.isclose(result.cost, right, rel_tol=1e-12):
        return RuleFault(f"cost is {right:.12g}, the result says {result.cost:.12g}")
    return None
