"""Claims of an answer over all optimal plans of the human: the answers in it are right (semantics 1)."""

from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from serendipity.model import Result, Task
from serendipity.model.answers.certificate import ClaimVerdict
from serendipity.model.numbers import agrees, as_written, excess, rounded
from verify.base import wording
from verify.base.obligations import is_mean
from verify.base.optimal_plans import OptimalPlans
from verify.certificate.achieved import NotAchievedError, achieved
from verify.certificate.claims import savings_fault
from verify.certificate.each_plan import EachPlan, SolvedPlan
from verify.programs.effort import Effort
from verify.rules.tied import tied_answers

Verdict = tuple[ClaimVerdict, str]
"""``proved`` or ``refuted``, and why."""


def combined(task: Task, result: Result, effort: Effort, plans: OptimalPlans) -> Verdict:
    """Compare an answer that breaks no rule, or a bound alone, with what every optimal ``pi_H`` allows.

    Raises:
        UsageError: there are more than ``max_ties``.
    """
    each = EachPlan(task, result.options, effort, plans)
    if result.status == "unknown":
        known = each.all()
        if any(solved.cost is None for solved in known):
            return "undecided", wording.TIE_WITHOUT_PLAN
        return _compared(result, known, each)
    worst = _is_worst(result, each)
    best = not worst and _is_best(result, each)
    if worst or best:
        each.asked = len(tied_answers(result))
    fault = _listed_fault(result, each) or _savings_fault(result, each)
    if fault is not None:
        return "refuted", fault
    if worst:
        return "proved", wording.NO_TIE_IS_DEARER.format(each.graph.count, result.cost or 0.0)
    if best and result.objective == _objective(result, each):
        return "proved", wording.NO_TIE_IS_CHEAPER.format(each.graph.count, result.cost or 0.0)
    fault = _unachieved(result, each, plans) if result.status == "feasible" else None
    if fault is not None:
        return "refuted", fault
    known = each.all()
    if any(solved.cost is None for solved in known):
        return "refuted", wording.TIE_WITHOUT_PLAN
    return _compared(result, known, each)


def _is_worst(result: Result, each: EachPlan) -> bool:
    """Whether ``robust`` has found as much as leaving the human alone costs: no answer is dearer."""
    alone = each.alone
    robust = result.status == "optimal" and result.options.ties == "robust"
    return robust and alone is not None and agrees(result.cost, alone) and agrees(result.objective, alone)


def _is_best(result: Result, each: EachPlan) -> bool:
    """Whether ``optimistic`` has found what nothing undercuts, whichever optimal plan the human is on."""
    if (result.status, result.options.ties) != ("optimal", "optimistic"):
        return False
    own = _own(result, each)
    if own is None or own.cost is None or not agrees(result.cost, own.cost):
        return False
    return each.none_cheaper(own.cost)


def _own(result: Result, each: EachPlan) -> SolvedPlan | None:
    """The answer beside the result's own plan; None: that is no optimal plan."""
    plan = each.graph.named(result.human_plan or ())
    return None if plan is None else each.beside(plan)


def _objective(result: Result, each: EachPlan) -> Fraction:
    """Of the answer beside the result's own plan, which is among those that are listed."""
    own = _own(result, each)
    assert own is not None and own.objective is not None, "looked at before"
    return own.objective


def _listed_fault(result: Result, each: EachPlan) -> str | None:
    """Whether something is wrong with one of the answers that the result lists."""
    for said in tied_answers(result):
        plan = each.graph.named(said.human_plan)
        if plan is None and not _is_at_hand(result):
            return wording.NOT_OPTIMAL_TIE
        if result.status != "optimal":
            continue
        assert plan is not None, "such an answer is not proved to be the best"
        solved = each.beside(plan)
        if not agrees(said.cost, solved.cost) or said.opportunity != solved.opportunity:
            return wording.tie_costs(said.human_plan, None if solved.cost is None else float(solved.cost))
    return None


def _savings_fault(result: Result, each: EachPlan) -> str | None:
    """Whether an answer with a plan saves something else, where no rule knows what robots owe."""
    plan = each.graph.named(result.human_plan or ())
    call = None if plan is None or result.plan is None else each.call(plan)
    if call is None or not call.robots_goal:
        return None
    baseline = None if call.baseline is None else call.prices.cost(call.baseline)
    return savings_fault(result, baseline, baseline, as_written(result.cost or 0.0))


def _unachieved(result: Result, each: EachPlan, plans: OptimalPlans) -> str | None:
    """Why an answer that was not proved can't be had, or has other figures than what it is made of."""
    listed = tied_answers(result)
    one = not is_mean(result) and result.options.ties == "expected"
    if one and result.opportunity and each.graph.count > 1:
        return wording.ONE_OF_SEVERAL
    found: list[SolvedPlan] = []
    for said in listed:
        plan = each.graph.named(said.human_plan)
        own = result.plan is not None and said.human_plan == result.human_plan  # which rules have replayed
        if plan is None or own or said.cost is None:
            continue
        try:
            found.append(achieved(said, plan, each, plans))
        except NotAchievedError as error:
            return str(error)
    if not is_mean(result):
        return None
    if len(found) != each.graph.count:
        return wording.TIES_MISSING
    return _mean_fault(result, Counter(found))


def _mean_fault(result: Result, found: Counter[SolvedPlan]) -> str | None:
    cost, objective = (_mean(found, lambda each: each.cost), _mean(found, lambda each: each.objective))
    if not agrees(result.cost, cost) or not agrees(result.objective, objective):
        return wording.OVER_TIES.format("expected", found.total(), float(cost))
    return _mean_savings_fault(result, found, cost)


def _mean_savings_fault(result: Result, known: Counter[Any], cost: Fraction) -> str | None:
    """Whether a mean saves something else; at a limit it need not be known what nobody but humans saves."""
    saving = None if any(each.saving is None for each in known) else _mean(known, lambda each: each.saving)
    open_yet = result.status == "feasible" and result.saving_alone is None
    alone = None if saving is None or open_yet else Fraction(0)
    if agrees(result.saving, saving) and agrees(result.saving_alone, alone):
        return None
    words = wording.OVER_TIES.format("expected", known.total(), float(cost))
    return wording.TIES_SAVINGS.format(words, rounded(saving), rounded(alone))


def _is_at_hand(result: Result) -> bool:
    """Whether a limit came before any optimal plan was known: robots do nothing beside another one."""
    unproved = result.status == "feasible" and result.saving_alone is None
    return unproved and not result.opportunity and len(tied_answers(result)) == 1


def _compared(result: Result, known: Counter[SolvedPlan], each: EachPlan) -> Verdict:
    """Compare the figures of an answer with those that the options make of all of them."""
    ties, count = result.options.ties, known.total()
    if ties == "expected":
        cost = _mean(known, lambda solved: solved.cost)
        objective = _mean(known, lambda solved: _net(solved, result))
    else:
        cost = (min if ties == "optimistic" else max)(solved.cost or Fraction(0) for solved in known)
        objective = min(_net(solved, result) for solved in known)
    words, least = wording.OVER_TIES.format(ties, count, float(cost)), objective
    if result.status != "optimal":
        assert result.lower_bound is not None, "a rule"
        if excess(result.lower_bound, least) > 0:
            return "refuted", wording.TIES_BOUND.format(words, ties)
        return "proved", words
    if result.plan is not None:  # one of the answers, which has an objective of its own
        least = _objective(result, each)
    if not agrees(result.cost, cost) or not agrees(result.objective, least):
        return "refuted", words
    fault = _mean_savings_fault(result, known, cost) if is_mean(result) else None  # else a rule says it
    return ("proved", words) if fault is None else ("refuted", fault)


def _net(solved: SolvedPlan, result: Result) -> Fraction:
    """The objective, net of a window of one epoch where the result claims no help that there is."""
    priced = solved.opportunity and result.options.windowed and result.options.human_model == "omniscient"
    net = priced and not result.opportunity
    return (solved.objective or Fraction(0)) - (result.options.window_weight if net else 0)


def _mean(known: Counter[Any], figure: Callable[[Any], Fraction | None]) -> Fraction:
    """Over all plans, of a figure that each of them has."""
    total = Fraction(0)
    for solved, number in known.items():
        total += (figure(solved) or Fraction(0)) * number
    return total / known.total()
