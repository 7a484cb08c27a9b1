"""Whether an answer over all optimal plans of the human has the right answers in it (semantics 1)."""

from collections import Counter
from collections.abc import Callable
from fractions import Fraction

from serendipity.model import Result, Task
from verify.base import wording
from verify.base.obligations import is_mean
from verify.base.optimal_plans import OptimalPlans
from verify.certificate.each_plan import EachPlan, Solved
from verify.programs.effort import Effort
from verify.rules.tied import tied_answers

Verdict = tuple[str, str]
"""``proved`` or ``refuted``, and why."""


def combined(task: Task, result: Result, effort: Effort, plans: OptimalPlans) -> Verdict:
    """Compare an answer with what every optimal ``pi_H`` allows.

    Args:
        task: the task.
        result: an answer that breaks no rule; status ``optimal`` or ``feasible``.
        effort: the solver's settings.
        plans: the human's optimal plans.

    Raises:
        UndecidedError: one of them could not be proved.
        UsageError: there are more than ``max_ties``.
    """
    each = EachPlan(task, result.options, effort, plans)
    worst = _is_worst(result, each)
    best = not worst and _is_best(result, each)
    if worst or best:
        each.asked = len(tied_answers(result))
    fault = _listed_fault(result, each)
    if fault is not None:
        return "refuted", fault
    if worst:
        return "proved", wording.no_tie_is_dearer(each.graph.count, result.cost or 0.0)
    if best and result.objective == _objective(result, each):
        return "proved", wording.no_tie_is_cheaper(each.graph.count, result.cost or 0.0)
    known = each.all()
    if any(solved.cost is None for solved in known):
        return "refuted", wording.TIE_WITHOUT_PLAN
    return _compared(result, known, each)


def _is_worst(result: Result, each: EachPlan) -> bool:
    """Whether ``robust`` has found as much as leaving the human alone costs: no answer is dearer."""
    alone = each.alone
    robust = result.status == "optimal" and result.options.ties == "robust"
    return robust and alone is not None and result.cost == result.objective == float(alone)


def _is_best(result: Result, each: EachPlan) -> bool:
    """Whether ``optimistic`` has found what nothing undercuts, whichever optimal plan the human is on."""
    if (result.status, result.options.ties) != ("optimal", "optimistic"):
        return False
    own = _own(result, each)
    if own is None or own.cost is None or float(own.cost) != result.cost:
        return False
    return each.none_cheaper(own.cost)


def _own(result: Result, each: EachPlan) -> Solved | None:
    """The answer beside the result's own plan; None: that is no optimal plan."""
    plan = each.graph.named(result.human_plan or ())
    return None if plan is None else each.beside(plan)


def _objective(result: Result, each: EachPlan) -> float:
    """Of the answer beside the result's own plan, which is among those that are listed."""
    own = _own(result, each)
    assert own is not None and own.objective is not None, "looked at before"
    return float(own.objective)


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
        right = (None if solved.cost is None else float(solved.cost), solved.opportunity)
        if (said.cost, said.opportunity) != right:
            return wording.tie_costs(said.human_plan, right[0])
    return None


def _is_at_hand(result: Result) -> bool:
    """Whether a limit came before any optimal plan was known: robots do nothing beside another one."""
    unproved = result.status == "feasible" and result.saving_alone is None
    return unproved and not result.opportunity and len(tied_answers(result)) == 1


def _compared(result: Result, known: Counter[Solved], each: EachPlan) -> Verdict:
    """Compare the figures of an answer with those that the options make of all of them."""
    ties, count = result.options.ties, known.total()
    if ties == "expected":
        cost = _mean(known, lambda solved: solved.cost)
        objective = _mean(known, lambda solved: solved.objective)
    else:
        cost = (min if ties == "optimistic" else max)(solved.cost or Fraction(0) for solved in known)
        objective = min(solved.objective or Fraction(0) for solved in known)
    words, least = wording.over_ties(ties, count, cost), float(objective)
    if result.status == "feasible":
        assert result.lower_bound is not None, "a rule"
        if result.lower_bound > least:
            return "refuted", wording.ties_bound(words, ties)
        return "proved", words
    if result.plan is not None:  # one of the answers, which has an objective of its own
        least = _objective(result, each)
    if (result.cost, result.objective) != (float(cost), least):
        return "refuted", words
    if is_mean(result):  # else a rule says what is saved
        right: tuple[float | None, float | None] = (None, None)
        if all(solved.saving is not None for solved in known):
            right = (float(_mean(known, lambda solved: solved.saving)), 0.0)
        if (result.saving, result.saving_alone) != right:
            return "refuted", wording.ties_savings(words, *right)
    return "proved", words


def _mean(known: Counter[Solved], figure: Callable[[Solved], Fraction | None]) -> Fraction:
    """Over all plans, of a figure that each of them has."""
    total = Fraction(0)
    for solved, number in known.items():
        total += (figure(solved) or Fraction(0)) * number
    return total / known.total()
