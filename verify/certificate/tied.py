"""Whether an answer over all optimal plans of the human has the right answers in it (semantics 1)."""

from dataclasses import dataclass
from fractions import Fraction

from serendipity.model import Result, Task
from verify.base import wording
from verify.base.obligations import is_mean
from verify.base.optimal_plans import OptimalPlans
from verify.calls.answer import answer, calls
from verify.calls.call import Call
from verify.certificate.humans import human_cost
from verify.programs.effort import Effort
from verify.rules.tied import tied_answers

Verdict = tuple[str, str]
"""``proved`` or ``refuted``, and why."""


@dataclass(frozen=True, slots=True)
class Solved:
    """The proved answer for one optimal ``pi_H``; None where there is no plan."""

    cost: Fraction | None
    objective: Fraction | None
    saving: Fraction | None
    opportunity: bool


Known = dict[tuple[str, ...], Solved]


def combined(task: Task, result: Result, effort: Effort, plans: OptimalPlans) -> Verdict:
    """Solve for every optimal ``pi_H`` and compare.

    Args:
        task: the task.
        result: an answer that breaks no rule; status ``optimal`` or ``feasible``.
        effort: the solver's settings.
        plans: the human's optimal plans.

    Raises:
        UndecidedError: one of them could not be proved.
        UsageError: there are more than ``max_ties``.
    """
    known: Known = {}
    for call in calls(task, result.options, None, effort, plans):
        names = tuple(task.actions[i].name for i in call.human_plan or ())
        known.setdefault(names, _solved(call))
    fault = _listed_fault(result, known)
    if fault is not None:
        return "refuted", fault
    if any(solved.cost is None for solved in known.values()):
        return "refuted", wording.TIE_WITHOUT_PLAN
    return _compared(result, known)


def _solved(call: Call) -> Solved:
    if call.options.human_model == "omniscient":
        found = answer(call)
        return Solved(found.cost, found.objective, found.saving, found.opportunity)
    cost = human_cost(call)
    if cost is None or call.baseline is None:  # whatever can be done then is an opportunity
        return Solved(cost, cost, None, opportunity=cost is not None)
    saving = max(call.prices.cost(call.baseline) - cost, Fraction(0))
    return Solved(cost, cost, saving, opportunity=saving > 0)


def _listed_fault(result: Result, known: Known) -> str | None:
    """Whether something is wrong with one of the answers that the result lists."""
    for said in tied_answers(result):
        solved = known.get(said.human_plan)
        if solved is None:
            return wording.NOT_OPTIMAL_TIE
        right = (None if solved.cost is None else float(solved.cost), solved.opportunity)
        if result.status == "optimal" and (said.cost, said.opportunity) != right:
            return wording.tie_costs(said.human_plan, right[0])
    return None


def _compared(result: Result, known: Known) -> Verdict:
    """Compare the figures of an answer with those that the options make of all of them."""
    ties, count = result.options.ties, len(known)
    costs = [solved.cost or Fraction(0) for solved in known.values()]
    objectives = [solved.objective or Fraction(0) for solved in known.values()]
    if ties == "expected":
        cost, objective = sum(costs, Fraction(0)) / count, sum(objectives, Fraction(0)) / count
    else:
        cost, objective = (min if ties == "optimistic" else max)(costs), min(objectives)
    words = wording.over_ties(ties, count, cost)
    if result.status == "feasible":
        assert result.lower_bound is not None, "a rule"
        if result.lower_bound > float(objective):
            return "refuted", wording.ties_bound(words, ties)
        return "proved", words
    if result.plan is not None:  # one of the answers, which has an objective of its own
        objective = known[result.human_plan or ()].objective or Fraction(0)
    if (result.cost, result.objective) != (float(cost), float(objective)):
        return "refuted", words
    if is_mean(result):  # else a rule says what is saved
        savings = [solved.saving for solved in known.values() if solved.saving is not None]
        if len(savings) < count:
            right: tuple[float | None, float | None] = (None, None)
        else:
            right = (float(sum(savings, Fraction(0)) / count), 0.0)
        if (result.saving, result.saving_alone) != right:
            return "refuted", wording.ties_savings(words, *right)
    return "proved", words
