"""A planner for a single agent beside the search (``classical="symk"``), where a call has no epochs to count.

What it says is checked as far as a plan can be: that nothing is cheaper rests on its word alone, until
``verify`` has looked, so ``statistics["proved_by"]`` names it where it has settled the call.
"""

import threading
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from typing import Final, NamedTuple

from search import WarmStart
from search.call.context import SearchContext
from search.classical.problem import ClassicalProblem
from search.human.individual_planner import FoundPlan
from search.human.whole_actions import alone_planner
from search.kernel.library import library
from search.packed.cost_vector import ACTIONS_BITS
from search.packed.parallelise import schedule
from search.strategies.first_answer import optimal_plan_alone
from serendipity.classical.fast_downward import SYMK, Found, absent, run_translated
from serendipity.facade.call import Request, Solver
from serendipity.facade.logs import record
from serendipity.model import UsageError
from serendipity.model.answers.answer import Answer, Improvement, Tried
from serendipity.model.errors import LIMITS, SerendipityError
from serendipity.model.keywords import require_one_of
from serendipity.model.numbers import total
from serendipity.model.options import INFINITE, Options
from serendipity.model.task.actions import apply

PLANNERS: Final = {"symk": SYMK}
"""Those that may be asked, by name."""

_REPLAYED: Final = "human-plan,warm-start,bound"
"""Strategies that put a plan into an answer, and look for no other."""

_MOST_COST: Final = 2**31
"""Where the integers of such planners end."""


class _Problem(NamedTuple):
    """A call in SAS+: the text, the actions of each operator, and what a cost of 1 there is here."""

    text: str
    actions: Sequence[tuple[int, ...]]
    unit: Fraction


def check_classical(name: str, options: Options) -> None:
    """Return if a planner of that name may be asked.

    Raises:
        UsageError: there is none, it is not installed, or it knows nothing of such calls.
    """
    require_one_of("classical", name, PLANNERS)
    if options.mode != "individual" and options.horizon != INFINITE:
        raise UsageError("classical: is for individual mode, and for composite mode without a horizon")
    missing = absent(PLANNERS[name], translates=False)
    if missing is None and library() is None:
        missing = "needs the compiled kernel, which is not there"
    if missing is not None:
        raise UsageError(f"classical: {missing}")


def answers(call: Request, solver: Solver, name: str) -> Iterator[Answer]:
    """The search's answers, while the planner works in a process; whoever proves one first ends the other."""
    try:
        problem = _problem(call)
    except LIMITS:
        problem = None
    if problem is None:  # which the search says soon, or nobody knows
        yield from solver(call)
        return
    over, proved = threading.Event(), threading.Event()
    last = Answer("unknown")

    def ask() -> Found:
        try:
            found = run_translated(problem.text, PLANNERS[name], call.deadline.within(cancelled=over))
        except SerendipityError as error:  # nothing depends on it
            record("WARNING", str(error), call.deadline.elapsed())
            return Found("unknown")
        if found.status != "unknown":
            proved.set()
        return found

    with ThreadPoolExecutor(1) as pool:
        asked = pool.submit(ask)
        try:
            for last in solver(call._replace(deadline=call.deadline.within(cancelled=proved))):
                yield last
            if last.status in ("optimal", "infeasible"):
                return
            found = asked.result()
        finally:
            over.set()
    yield _answer(call, solver, problem, found, name, last)


def _answer(
    call: Request, solver: Solver, problem: _Problem, found: Found, name: str, last: Answer
) -> Answer:
    """The last answer of the search, or a better one, by what the planner has found."""
    answer, individual = last, call.options.mode == "individual"
    bound = None if found.lower_bound is None else int(found.lower_bound) * problem.unit
    if found.status == "infeasible" and (individual or not call.task.robot_goal):
        reason = "no-human-plan" if individual else "no-plan"
        answer = Answer("infeasible", reason=reason, horizon=last.horizon)
    elif found.plan is not None:
        known = {str(number): chosen for number, chosen in enumerate(problem.actions)}
        sets = [known.get(number, ()) for number in found.plan]
        cost = _cost(call, sets) if all(sets) else None
        if cost is None or cost != bound:
            record("WARNING", f"{name}: its plan does not work, or costs something else", found.seconds)
            bound = None
        elif individual:
            optimum = FoundPlan(tuple(action for chosen in sets for action in chosen), 0, 0)
            answer = optimal_plan_alone(call.task, call.given, optimum)
        else:
            start = WarmStart(schedule(call.task, sets), None, True, cost, True, INFINITE)
            rest = call.deadline if call.deadline.reached() is None else call.limits
            options = call.options.but(strategies=_REPLAYED)
            *_, answer = solver(call._replace(options=options, start=start, deadline=rest))
            if answer.cost is None or (last.cost is not None and last.cost < answer.cost):
                answer = last
    if answer.status == "feasible" and answer.objective is not None and bound is not None:
        least = max(bound, answer.lower_bound or Fraction(0))
        answer = answer._replace(lower_bound=min(least, answer.objective))
    settled = answer.status in ("optimal", "infeasible")
    row = Tried(name, found.seconds, int(answer.cost != last.cost), bound, settled)
    gap = last.gap
    if answer.cost is not None:
        now = Improvement(call.deadline.elapsed(), answer.objective, answer.lower_bound)
        gap = (*(gap or ()), now)
    return answer._replace(tried=(*last.tried, row), gap=gap, proved_by=name if settled else None)


def _cost(call: Request, sets: Sequence[tuple[int, ...]]) -> Fraction | None:
    """What sets of actions one after another cost; None where that is no plan of the call."""
    task, state = call.task, call.task.init
    actions = [[task.actions[i] for i in chosen] for chosen in sets]
    for together in actions:
        if not all(action.applicable(state) for action in together):
            return None
        state = apply(state, *together)
    if not task.goal.holds(state) or (call.options.mode != "individual" and not task.robot_goal.holds(state)):
        return None
    return total(task.team_cost(action, call.options.discount) for together in actions for action in together)


def _problem(call: Request) -> _Problem | None:
    """The call as the kernel's problem, in SAS+; None where it is none, as with a goal that no state meets.

    Raises:
        UsageError: it has costs that such planners can't add up.
    """
    context = SearchContext(call.prepared, call.options, call.deadline)
    problem: ClassicalProblem | None = None
    actions: list[tuple[int, ...]] = []
    if call.options.mode == "individual":
        own = alone_planner(context.packed, context.packed.goal, call.deadline)
        if own is not None:
            problem = own.planner.problem
            actions = [(op.action,) for op in problem.operators]
    elif context.team is not None:
        problem, actions = context.team.planner.problem, context.team.actions
    if problem is None:
        return None
    costs = [weight >> ACTIONS_BITS for weight in problem.weights]
    if sum(costs) >= _MOST_COST:
        raise UsageError("classical: costs and discount have too large a common denominator")
    priced = next((number for number, cost in enumerate(costs) if cost), None)
    unit = Fraction(0) if priced is None else _price(call, actions[priced]) / costs[priced]
    return _Problem(_sas(problem, costs, context.packed.init), actions, unit)


def _price(call: Request, chosen: Sequence[int]) -> Fraction:
    return total(call.task.team_cost(call.task.actions[i], call.options.discount) for i in chosen)


def _sas(problem: ClassicalProblem, costs: Sequence[int], init: int) -> str:
    """A problem in SAS+ (Helmert 2009, version 3 of Fast Downward's format).

    Where one of several values of a field is forbidden, a variable of its own says whether it has that value.
    """
    place = {field: number for number, (field, _) in enumerate(problem.fields)}
    sizes = [size for _, size in problem.fields]
    literals = {pair for op in problem.operators for pair in op.forbidden} | {*problem.goal.forbidden}
    told = {pair: len(sizes) + number for number, pair in enumerate(sorted(literals))}
    by_field: dict[int, list[int]] = {}
    for field, value in told:
        by_field.setdefault(field, []).append(value)

    def values(mask: int, state: int, forbidden: Sequence[tuple[int, int]] = ()) -> dict[int, int]:
        found = {place[f]: (state & f) // (f & -f) for f in place if f & mask}
        return found | {told[pair]: 0 for pair in forbidden}

    def with_told(mask: int, state: int) -> dict[int, int]:
        known = {told[f, v]: int(state & f == v) for f in by_field if f & mask for v in by_field[f]}
        return values(mask, state) | known

    lines = ["begin_version", "3", "end_version", "begin_metric", "1", "end_metric"]
    lines.append(str(len(sizes) + len(told)))
    for number, size in enumerate([*sizes, *(2 for _ in told)]):
        atoms = (f"Atom is{value}(v{number})" for value in range(size))
        lines += ["begin_variable", f"var{number}", "-1", str(size), *atoms, "end_variable"]
    start = with_told(problem.mask, init)
    lines += ["0", "begin_state", *(str(start[number]) for number in sorted(start)), "end_state"]
    lines += [
        "begin_goal",
        *_counted(values(problem.goal.need_mask, problem.goal.need, problem.goal.forbidden)),
    ]
    lines += ["end_goal", str(len(problem.operators))]
    for number, (op, cost) in enumerate(zip(problem.operators, costs, strict=True)):
        asked = values(op.need_mask, op.need, op.forbidden)
        put = with_told(problem.mask & ~op.keep, op.put)
        kept = {variable: value for variable, value in asked.items() if variable not in put}
        effects = (f"0 {variable} {asked.get(variable, -1)} {value}" for variable, value in put.items())
        lines += ["begin_operator", str(number), *_counted(kept), str(len(put)), *effects, str(cost)]
        lines.append("end_operator")
    return "\n".join([*lines, "0", ""])


def _counted(values: Mapping[int, int]) -> Iterator[str]:
    yield str(len(values))
    yield from (f"{variable} {value}" for variable, value in values.items())
