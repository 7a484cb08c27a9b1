"""Whether an answer that is listed over ties can be had: by its plan, or by what is best beside ``pi_H``."""

from dataclasses import replace
from fractions import Fraction

from serendipity.model import HumanPlan, Result, Step
from serendipity.model.answers.result_parts import TiedAnswer
from serendipity.model.numbers import agrees, as_written
from verify.base import wording
from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import PricedPlan
from verify.base.undecided import UndecidedError
from verify.calls.call import ExaminedCall
from verify.calls.methods import decide
from verify.calls.results import found_result
from verify.certificate.each_plan import EachPlan, SolvedPlan
from verify.certificate.simulator import realised_claim
from verify.rules import Checker
from verify.rules.replay import replay


class NotAchievedError(Exception):
    """An answer can't be had; the text says why."""


def achieved(said: TiedAnswer, plan: HumanPlan, each: EachPlan, plans: OptimalPlans) -> SolvedPlan:
    """The figures of a listed answer that has a cost.

    Args:
        plan: its ``pi_H`` by ids.

    Raises:
        NotAchievedError: it has other figures, or there is nothing that costs so little.
        UndecidedError: it does not say by which plan, and nobody could tell.
    """
    if said.plan is not None:
        return _by_its_plan(said, each.call(plan), plans)
    solved = each.beside(plan)
    if agrees(said.cost, solved.cost) and said.opportunity == solved.opportunity:
        return solved
    if agrees(said.cost, each.alone) and not said.opportunity and each.alone is not None:
        return SolvedPlan(each.alone, each.alone, Fraction(0), opportunity=False)
    if solved.cost is None or _is_too_cheap(said, solved.cost, each.call(plan)):
        cost = None if solved.cost is None else float(solved.cost)
        raise NotAchievedError(wording.tie_costs(said.human_plan, cost))
    raise UndecidedError(wording.TIE_WITHOUT_ITS_PLAN)


def _by_its_plan(said: TiedAnswer, call: ExaminedCall, plans: OptimalPlans) -> SolvedPlan:
    deadline, strict = call.effort.deadline, call.options.strict
    sets = replay(call.task, said.plan or (), deadline, strict=strict).sets
    steps = tuple(Step(epoch, i) for epoch, chosen in sets.items() for i in chosen)
    objective, cost = call.endless.measure(steps, said.window)
    found = found_result(call, PricedPlan(steps, said.window, objective, cost), opportunity=said.opportunity)
    result = replace(found, options=call.options.but(ties="fixed"), plan=said.plan)
    report = Checker(call.task, plans.alone).check(result)
    if not report.ok:
        raise NotAchievedError(wording.tie_breaks(said.human_plan, report.first))
    if report.undecided:
        raise UndecidedError(next(iter(report.undecided.values())))
    _require_realised(call, result, plans)
    if not agrees(said.cost, call.prices.cost(cost)):
        raise NotAchievedError(wording.tie_costs(said.human_plan, float(call.prices.cost(cost))))
    saving = None if result.saving is None else as_written(result.saving)
    return SolvedPlan(call.prices.cost(cost), call.prices.cost(objective), saving, said.opportunity)


def _require_realised(call: ExaminedCall, result: Result, plans: OptimalPlans) -> None:
    """Return if the plan is what happens with a human who replans, or raise a NotAchievedError."""
    claim = realised_claim(call.task, result, plans)
    if claim is not None and claim.verdict == "refuted":
        raise NotAchievedError(wording.tie_breaks(result.human_plan or (), claim.reason))
    if claim is not None and claim.verdict != "proved":
        raise UndecidedError(claim.reason)


def _is_too_cheap(said: TiedAnswer, best: Fraction, call: ExaminedCall) -> bool:
    """Whether no plan costs as little as that; the best one may cost more, and have a lower objective."""
    assert said.cost is not None
    cost = as_written(said.cost)
    if cost >= best or call.options.human_model != "omniscient":
        return cost < best
    question = call.question.below(None, call.prices.units(cost))
    return decide(question, call.effort, call.plans).settled() is None
