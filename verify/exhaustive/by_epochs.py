"""Questions with epochs that an exhaustive search answers, in machine words or else in Python's integers."""

from dataclasses import replace

from verify.base.control import HumanControl, expected_states
from verify.base.optimal_plans import OptimalPlans
from verify.base.relevance import relevant_part
from verify.base.subproblem import Subproblem
from verify.base.undecided import during
from verify.exhaustive.epoch_by_epoch import EpochSearch, OtherMethodError
from verify.limits import limits
from verify.packed.cheapest_path import SumTooLargeError
from verify.packed.problem import TooLargeError
from verify.programs.effort import Minimum


def cheapest_by_epochs(question: Subproblem, plans: OptimalPlans, *, bounded: bool) -> Minimum:
    """The plan of least objective.

    Args:
        bounded: whether lower bounds spare the search states; else only what was paid does.
    """
    with during("preparing an exhaustive search"):
        expected = expected_states(question)
        part = relevant_part(question, frozenset().union(*expected))
        if part is None:
            return Minimum("none")
        if len(part.actions) > limits().compared_actions:
            raise OtherMethodError(f"the exhaustive method takes {limits().compared_actions} actions at most")
        control, exact = HumanControl(question, expected), not _in_words(question)
        try:
            search = EpochSearch(question, part, control, plans, bounded=bounded, exact=exact)
        except TooLargeError:
            raise OtherMethodError("the task is too large for the exhaustive method") from None
    return replace(search.run(), states=search.states)


def cheapest_following(question: Subproblem, plans: OptimalPlans) -> Minimum:
    """The least cost of a plan in which the human executes ``pi_H`` epoch by epoch and is then idle.

    That is what doing nothing for the human costs without a horizon, where robots have goals (semantics 3.1):
    they reach ``G_R`` without the human, at the same time or after the end of ``pi_H``.

    Args:
        question: its horizon is not looked at; its rule is ``exact``.
    """
    question = question.but(horizon=len(question.human_plan))
    for exact in (False, True):
        try:
            with during("preparing the search for the robots' own plans"):
                part = relevant_part(question)
                if part is None:
                    return Minimum("none")
                search = EpochSearch(question, part, HumanControl(question), plans, bounded=True, exact=exact)
            return search.run_on()
        except (TooLargeError, SumTooLargeError):
            continue  # sums may be: then once more with Python's integers
    return Minimum("undecided", reason="the task is too large for the exhaustive method")


def _in_words(question: Subproblem) -> bool:
    """True if machine words hold all sums of costs; a unit of cost weighs more than all epochs."""
    largest = (question.largest + question.an_epoch + 1) * (question.horizon + 1)
    every = sum(question.prices.team) + sum(question.prices.talk)
    return max(largest, every * (question.horizon + len(question.task.agents))) <= limits().weight
