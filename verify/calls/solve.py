"""``serendipity solve``: the integer program answers from scratch, in every mode of semantics 3."""

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from time import perf_counter

from serendipity.model import Deadline, HumanPlan, Options, Result, Task, UsageError
from serendipity.model.answers.result_parts import TiedAnswer
from serendipity.model.numbers import figure
from serendipity.model.resources.collection import no_collection
from serendipity.model.task.gate import is_bound, needs_time
from serendipity.model.task.plans import PlanEntry
from verify.base.individual import IndividualOptimum
from verify.base.obligations import TIED_MODES
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import UNDECIDED, why
from verify.calls.answer import CallAnswer, answer, calls
from verify.calls.results import to_result
from verify.calls.solve_in_time import solved_in_time
from verify.limits import limits
from verify.programs.effort import Effort
from verify.solvers.mip import solver_version


def solve(
    task: Task,
    options: Options,
    *,
    human_plan: Iterable[PlanEntry] | None = None,
    encoding: str = "automata",
    solver: str = "highs",
    method: str = "pruned",
    deadline: Deadline | None = None,
) -> Result:
    """The best plan by integer programming alone: slow, and independent of the search.

    Args:
        options: mode and options; ``time_limit`` (seconds) and ``memory_limit`` (MiB, the solver's
            included) bound the whole call.
        human_plan: what the human is going to do, as :func:`serendipity.plan` takes it; None predicts it.
        encoding: ``automata`` or ``paper``.
        solver: ``highs`` or ``cbc``.
        method: ``pruned``: programs alone; the others as :class:`verify.programs.effort.Effort` has them.
        deadline: one that other work shares, such as loading the task; it holds beside the limits.

    Returns:
        A result with status ``optimal`` or ``infeasible``, or ``unknown`` where the limit
        came first (``reason`` says which).

    Raises:
        UsageError: a mode or option that no integer program answers, or no such solver.
        PlanError: ``human_plan`` can't be executed, or misses the goal.
    """
    if options.mode == "assistance" or options.human_model != "omniscient":
        raise UsageError("solve: expected a mode other than 'assistance' and the omniscient human model")
    if is_bound(task, options):
        raise UsageError(
            "solve: knows no rules of help (semantics 12 to 14); "
            "beside bystanders expected nobody_pays=False (--somebody-pays)"
        )
    started = perf_counter()
    end = (deadline or Deadline()).within(options.time_limit, options.memory_limit)
    effort = Effort(encoding, solver, end.sooner(limits().end_share), method)
    given: HumanPlan | None = None
    if human_plan is not None:
        given = task.plan_from_names(human_plan, options.head_start)
        options = options.but(ties="fixed")  # there is but one plan
    with no_collection():  # beside a large task a collection takes longer than a short limit
        try:
            solved = solved_in_time if needs_time(task, options=options, plan=given) else _solve
            result = solved(task, options, given, effort)
        except UNDECIDED as error:
            human = task.agents[task.human]
            result = Result(options.mode, "unknown", human, options, reason=why(error))
    statistics = {
        "elapsed_seconds": perf_counter() - started,
        "solver": solver_version(solver),
        "encoding": encoding,
        "solver_calls": len(effort.calls),
        **effort.size,
    }
    return replace(result, statistics={**result.statistics, **statistics})


def _solve(task: Task, options: Options, given: HumanPlan | None, effort: Effort) -> Result:
    plans = OptimalPlans(task, IndividualOptimum(task, effort.deadline))
    answers = [answer(call) for call in calls(task, options, given, effort, plans)]
    tied = options.ties != "fixed" and options.mode in TIED_MODES
    several = tied and answers[0].call.human_plan is not None
    return over_ties(answers, options.ties) if several else to_result(answers[0])


def over_ties(answers: list[CallAnswer], ties: str) -> Result:
    """One result from the answers for all optimal ``pi_H`` (semantics 1)."""
    results = [to_result(each) for each in answers]
    listed = tuple(TiedAnswer(r.human_plan or (), r.cost, r.opportunity) for r in results)
    missing = next((r for r in results if r.cost is None), None)
    if missing is not None:
        chosen = missing
    elif ties == "expected":
        chosen = _mean(answers, results)
    else:
        costs = [each.cost or Fraction(0) for each in answers]
        wanted = min(costs) if ties == "optimistic" else max(costs)
        chosen = results[costs.index(wanted)]
    return replace(chosen, ties=listed)


def _mean(answers: list[CallAnswer], results: list[Result]) -> Result:
    """The expected answer: means of the figures, no single plan."""

    def mean(values: Iterable[Fraction | None]) -> float | None:
        known = [value for value in values if value is not None]
        return figure(sum(known, Fraction(0)) / len(known)) if len(known) == len(answers) else None

    if len(results) == 1:
        return results[0]
    objective = mean(each.objective for each in answers)
    return replace(
        results[0],
        opportunity=any(each.opportunity for each in answers),
        cost=mean(each.cost for each in answers),
        saving=mean(each.saving for each in answers),
        saving_alone=None if any(each.saving is None for each in answers) else 0.0,
        objective=objective,
        lower_bound=objective,
        window=None,
        plan=None,
        agent_costs={},
    )
