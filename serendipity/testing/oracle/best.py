"""The optimum of a call: beside one plan of the human, or over all of their optimal ones."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import islice

from serendipity.model import HumanPlan, Options, Task, TimedPlan, UsageError
from serendipity.testing.oracle.alone import human_plans
from serendipity.testing.oracle.alone_in_time import plans_in_time
from serendipity.testing.oracle.answers import Optimum, Solver
from serendipity.testing.oracle.in_time import SolverInTime, shifted


def best(task: Task, options: Options, human_plan: HumanPlan | None = None) -> Optimum:
    """The exact answer to a call.

    Args:
        human_plan: ``pi_H`` where it is given; else it is predicted.

    Raises:
        UsageError: the horizon is missing or too short, or there are too many ties.
    """
    if task.needs_time or options.waiting_cost or options.head_start or isinstance(human_plan, TimedPlan):
        solver: type[Solver] = SolverInTime
        human_plan = None if human_plan is None else shifted(task, human_plan, options.head_start)
    else:
        solver = Solver
    if human_plan is None and options.ties != "fixed" and options.mode in ("serendipity", "communication"):
        plans = list(islice(_plans(task, options, solver), options.max_ties + 1))
        if len(plans) > options.max_ties:
            raise UsageError("ties: too many optimal human plans")
        if plans:
            return _over_ties(
                [solver(task, options, plan, given=False).solve() for plan in plans], options.ties
            )
    plan = next(_plans(task, options, solver), None) if human_plan is None else human_plan
    return solver(task, options, plan, given=human_plan is not None).solve()


def _plans(task: Task, options: Options, solver: type[Solver]) -> Iterator[HumanPlan]:
    """The human's optimal plans, the canonical one first."""
    if solver is Solver:
        return human_plans(task)
    return plans_in_time(task, options.waiting_cost, options.head_start, strict=options.strict)


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
