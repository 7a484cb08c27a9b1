"""The optimum of a call: beside one plan of the human, or over all of their optimal ones."""

from collections.abc import Iterable
from fractions import Fraction
from itertools import islice

from serendipity.model import HumanPlan, Options, Task, UsageError
from serendipity_testing.oracle.alone import as_human_plan, human_plans
from serendipity_testing.oracle.answers import Optimum, Solver


def best(task: Task, options: Options, human_plan: HumanPlan | None = None) -> Optimum:
    """The exact answer to a call.

    Args:
        human_plan: ``pi_H`` where it is given; else it is predicted.

    Raises:
        UsageError: the horizon is missing or too short, or there are too many ties.
    """
    if human_plan is not None:
        return Solver(task, options, shifted(task, human_plan, options.head_start), given=True).solve()
    predicted = human_plans(task, options.waiting_cost, options.head_start, strict=options.strict)
    if options.ties == "fixed" or options.mode not in ("serendipity", "communication"):
        return Solver(task, options, next(predicted, None), given=False).solve()
    plans = list(islice(predicted, options.max_ties + 1))
    if len(plans) > options.max_ties:
        raise UsageError("ties: too many optimal human plans")
    answers = [Solver(task, options, plan, given=False).solve() for plan in plans or (None,)]
    return _over_ties(answers, options.ties)


def shifted(task: Task, plan: HumanPlan, epochs: int) -> HumanPlan:
    """A plan with some epochs of waiting before it."""
    starts = tuple(start + epochs for start in task.starts_of(plan))
    return as_human_plan(task, tuple(plan), starts, task.epochs_of(plan) + epochs)


def _over_ties(answers: list[Optimum], ties: str) -> Optimum:
    costs = [answer.cost for answer in answers if answer.cost is not None]
    if len(costs) < len(answers):
        return next(answer for answer in answers if answer.cost is None)
    if ties == "expected" and len(answers) > 1:
        return Optimum(
            "optimal",
            cost=_mean(answer.cost for answer in answers),
            objective=_mean(answer.objective for answer in answers),
            opportunity=any(answer.opportunity for answer in answers),
            human_cost=answers[0].human_cost,
            saving=_mean(answer.saving for answer in answers),
        )
    chosen = (max if ties == "robust" else min)(costs)
    return next(answer for answer in answers if answer.cost == chosen)


def _mean(amounts: Iterable[Fraction | None]) -> Fraction | None:
    """None where one of them is not known."""
    listed = list(amounts)
    known = [amount for amount in listed if amount is not None]
    return sum(known, Fraction(0)) / len(known) if len(known) == len(listed) else None
