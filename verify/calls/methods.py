"""What decides a question: integer programs, an exhaustive search, or both in turns."""

from dataclasses import replace
from itertools import count
from math import log2
from typing import Final

from serendipity.model import Window
from verify.base.optimal_plans import OptimalPlans
from verify.base.small_numbers import with_small_numbers
from verify.base.subproblem import FREE, WINDOW, Solution, Subproblem
from verify.base.undecided import UNDECIDED, UndecidedError, why
from verify.beside.short_windows import is_short, no_short_window
from verify.exhaustive.epoch_by_epoch import OtherMethodError, answers, cheapest_by_epochs
from verify.exhaustive.uniform_cost import cheapest
from verify.limits import limits
from verify.programs.effort import Attempt, Effort, Minimum
from verify.programs.minimise import minimise

_TURNS: Final = (0.4, 4.0, 4.0, 40.0, 40.0)
"""Seconds of the first turns, of programs and exhaustive search; the last two go on, longer and longer."""

_LONGER: Final = 10

_EASIER: Final = 60.0
"""Seconds for an easier question at most."""

_FEW_STATES: Final = 64.0
"""Bits of a state: with more of them programs begin with a long turn."""

_SHARE: Final = 0.4
"""What of the time that is left a turn may take."""


def decide(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """The least objective of a question, by the method that the effort names.

    ``auto`` takes turns, each far longer than the last of the same method, so that what the other one wastes
    is little.  Programs come first: most questions they close at once.  Where there are many states
    they get longer for it, since an exhaustive search is the less likely to end.

    ``exhaustive`` has no bound to trust on what is still to be paid; in turns there is one.

    Args:
        question: with a horizon.
        effort: method, deadline and solver; what is spent is noted there.
        plans: the human's optimal plans.
    """
    small, order = with_small_numbers(question)
    if small is question:
        return _decide(question, effort, plans)
    asked = len(effort.calls)
    found = _decide(small, effort, plans)
    for call in effort.calls[asked:]:
        if call.objective is not None and call.cost is not None:
            call.objective, call.cost = order.bound(call.objective), order.bound(call.cost)
    if found.bound is not None:
        found = replace(found, bound=order.bound(found.bound))
    if found.found is None:
        return found
    objective, cost = question.measure(found.found.steps, found.found.window)
    return replace(found, found=replace(found.found, objective=objective, cost=cost))


def _decide(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    if is_free(question):
        found = _decide(question.but(rule=FREE), effort, plans)
        return found if found.found is None else replace(found, found=_throughout(question, found.found))
    if effort.method == "exhaustive" and question.horizon > 0:
        return _exhaustively(question, effort, plans)
    if effort.method != "auto" or effort.encoding != "automata" or not question.horizon:
        return _by_programs(question, effort, plans)
    return _relaxed(question, effort, plans) or _in_turns(question, effort, plans)


def decide_without_horizon(question: Subproblem, effort: Effort) -> Minimum:
    """The least cost of a plan with any number of epochs: no program says that, an exhaustive search does."""
    attempts = len(effort.attempts)
    found = cheapest(question, effort)
    if len(effort.attempts) == attempts:  # numbers of actions did not decide it
        effort.attempts.append(Attempt("exhaustive", found.status != "undecided", found.states))
    return found


def is_free(question: Subproblem) -> bool:
    """Whether the window of all epochs is as good as any: no epoch of it costs, and none is too many.

    There is neither prefix nor suffix then, so that every plan fits it.
    """
    options, longest = question.options, question.options.max_window
    return (
        question.rule == WINDOW
        and not question.prices.epoch
        and (longest is None or longest >= question.horizon)
        and bool(question.human_plan)
        and options.preservation == "kernel"
        and not options.keep_prefix
    )


def _throughout(question: Subproblem, found: Solution) -> Solution:
    """A plan whose window is all epochs."""
    return replace(found, window=Window(1, question.horizon + 1))


def _searchable(question: Subproblem) -> bool:
    task = question.task
    small = len(task.facts) <= limits().packed_facts and len(task.actions) <= limits().compared_actions
    return small and answers(question)


def _relaxed(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum | None:
    """The answer as far as an easier question tells, after a moment for programs; None: it does not."""
    task = question.task
    large = len(task.facts) > limits().packed_facts or len(task.actions) > limits().packed_actions
    if question.most is None or large:
        return None
    easier = _one_by_one if is_short(question) else _without_epochs if question.rule == FREE else None
    if easier is None:
        return None
    # buildings, say: programs are good at them
    long = easier is _without_epochs and _bits(question) > _FEW_STATES
    moment = effort.deadline.part(_SHARE).within(_length(2 * long))
    found = _by_programs(question.but(deadline=moment), replace(effort, deadline=moment), plans)
    if found.status == "undecided" and effort.deadline.reached() is None:
        part = effort.deadline.part(_SHARE).within(_EASIER)
        found = easier(question.but(deadline=part), replace(effort, deadline=part))
    return None if found.status == "undecided" and effort.deadline.reached() is None else found


def _one_by_one(question: Subproblem, effort: Effort) -> Minimum:
    """Whether robots one by one, and then the human alone, leave no plan."""
    found, states = no_short_window(question)
    if found.status == "none":
        effort.attempts.append(Attempt("exhaustive", decided=True, states=states, apart=True))
    return found


def _without_epochs(question: Subproblem, effort: Effort) -> Minimum:
    """Whether there is no plan even if epochs did not count."""
    given = replace(effort, attempts=[])
    try:
        found = decide_without_horizon(question, given)
    except UNDECIDED as error:
        return Minimum("undecided", reason=why(error))
    if found.status != "none":
        return Minimum("undecided", bound=found.bound, reason=found.reason)
    effort.attempts.extend(given.attempts)
    return found


def _in_turns(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    bounds: list[int] = []
    asked = [_by_programs, _exhaustively] if _searchable(question) else [_by_programs]
    long_first = _bits(question) > _FEW_STATES
    for turn in count():
        seconds = _length(turn + 2 * long_first)
        left = effort.deadline.left()
        last = len(asked) == 1
        if left is not None and not last:
            last = left * _SHARE < seconds / _LONGER
            seconds = min(seconds, left * _SHARE)
        deadline = effort.deadline if last else effort.deadline.within(seconds)
        method = asked[turn % len(asked)]
        given = replace(effort, deadline=deadline)
        found = method(question.but(deadline=deadline), given, plans)
        if found.bound is not None:
            bounds.append(found.bound)
        if found.status != "undecided" or effort.deadline.reached() is not None:
            break
        if last or (method is _exhaustively and not deadline.reached()):
            asked = [each for each in asked if each is not method]  # more time would not help
        if not asked:
            break
    return replace(found, bound=max(bounds, default=None))


def _length(turn: int) -> float:
    """Seconds of a turn."""
    beyond = max(0, turn - len(_TURNS) + 2) // 2
    return float(_TURNS[turn - 2 * beyond] * _LONGER**beyond)


def _bits(question: Subproblem) -> float:
    """The logarithm of the number of states, as far as the task's variables tell."""
    return sum(log2(max(2, len(variable.facts))) for variable in question.task.variables)


def _by_programs(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    if effort.method == "auto" and question.horizon and not limits().programs:
        return Minimum("undecided", reason="programs are left out")
    return minimise(question, effort, plans)


def _exhaustively(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    try:
        found, states = cheapest_by_epochs(question, plans, bounded=effort.method != "exhaustive")
    except OtherMethodError as error:
        return Minimum("undecided", reason=str(error))
    except UNDECIDED as error:
        bound = error.bound if isinstance(error, UndecidedError) else None
        return Minimum("undecided", bound=bound, reason=why(error))
    effort.attempts.append(Attempt("exhaustive", found.status != "undecided", states))
    return found
