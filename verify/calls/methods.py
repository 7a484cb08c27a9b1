"""The methods that decide a question, in one table, and the loop that deals out the time to them."""

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import log2
from time import perf_counter
from typing import Final

from serendipity.model import Deadline, UsageError, Window
from serendipity.model.options import MAX_EPOCH
from verify.base.execution import awake
from verify.base.optimal_plans import OptimalPlans
from verify.base.small_numbers import with_small_numbers
from verify.base.subproblem import FREE, Subproblem
from verify.base.undecided import UNDECIDED, UndecidedError, why
from verify.exhaustive.beside_plans import answers_all
from verify.exhaustive.by_epochs import cheapest_by_epochs
from verify.exhaustive.decoupled.short_windows import is_short, no_short_window
from verify.exhaustive.epoch_by_epoch import OtherMethodError
from verify.exhaustive.without_epochs import cheapest
from verify.limits import PARTS, limits, uses
from verify.programs.effort import Attempt, Effort, Minimum
from verify.programs.minimise import minimise

_FEW_STATES: Final = 64.0
"""Bits of a state: with more of them an exhaustive search is the less likely to end."""


# -- whether a method applies


def _always(question: Subproblem) -> bool:
    del question
    return True


def _is_packed(question: Subproblem) -> bool:
    """True if states of the task can be packed."""
    task = question.task
    return len(task.facts) <= limits().packed_facts and len(task.actions) <= limits().packed_actions


def _has_short_windows(question: Subproblem) -> bool:
    """True if windows have one epoch, nothing is joint or happens anyway, and the human replans after it."""
    return _is_packed(question) and is_short(question) and not question.task.of_bystanders


def _has_many_plans(question: Subproblem) -> bool:
    """True if windows open beside any optimal plan, and the human replans after them."""
    return question.has_plain_windows and not question.is_free and not question.task.due


def _is_without_windows(question: Subproblem) -> bool:
    """True if anybody may do anything at any time, for a limited cost."""
    return question.most is not None and question.rule == FREE and _is_packed(question)


def _has_few_actions(question: Subproblem) -> bool:
    """True if all joint actions can be compared with each other."""
    return len(question.task.actions) <= limits().compared_actions and _is_packed(question)


# -- what a method does


def _decoupled(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """A proof that robots one by one, and then the human alone, leave no plan."""
    del effort, plans
    return no_short_window(question)


def _without_epochs(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """A proof that there is no plan even if epochs did not count."""
    del plans
    try:
        found = cheapest(question, effort)
    except UNDECIDED as error:
        return Minimum("undecided", reason=why(error))
    return found if found.status == "none" else replace(found, status="undecided", found=None)


def _exhaustively(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    try:
        return cheapest_by_epochs(question, plans, bounded=effort.method != "exhaustive")
    except OtherMethodError as error:
        return Minimum("undecided", reason=str(error))
    except UNDECIDED as error:
        bound = error.bound if isinstance(error, UndecidedError) else None
        return Minimum("undecided", bound=bound, reason=why(error))


# -- the table


@dataclass(frozen=True, slots=True)
class Method:
    """A row of the table.

    Attributes:
        name: by which it is chosen and told of.
        proves: what it can say of a question: its ``optimum``, or that there is ``no plan``.
        applies: a test of a question.
        share: of the time left that a turn takes at most.
        seconds: of its first turn at most.
        longer: how many times as long each turn is as the one before; 0: there is no second one.
        run: answers a question by its deadline; None: whoever asks does.
    """

    name: str
    proves: str
    applies: Callable[[Subproblem], bool]
    share: float
    seconds: float
    longer: int = 0
    run: Callable[[Subproblem, Effort, OptimalPlans], Minimum] | None = None

    def turn(self, whole: Deadline, number: int = 0) -> Deadline:
        """The deadline of a turn that begins now; they are numbered from 0."""
        return whole.part(self.share).within(self.seconds * max(self.longer, 1) ** number)

    def is_last(self, whole: Deadline, number: int) -> bool:
        """Whether so little time is left that it had better have all of it."""
        left = whole.left()
        return left is not None and left * self.share < self.seconds * self.longer ** (number - 1)


TURNS: Final = (
    #      name, what it proves of a question, whether it applies, share, seconds, longer, what it does
    Method("programs", "optimum", _always, 0.4, 0.4, 10, minimise),
    Method("decoupled", "no plan", _has_short_windows, 0.4, 60, 0, _decoupled),
    Method("without-epochs", "no plan", _is_without_windows, 0.4, 60, 0, _without_epochs),
    Method("exhaustive", "optimum", _has_few_actions, 0.4, 4, 10, _exhaustively),
)
"""What decides a question with a horizon, in turns: programs close most of them at once."""

ANY_PLAN: Final = Method("any-plan", "no plan", _has_many_plans, 0.4, 4)
"""One program for all optimal plans of the human, before each is asked about."""

BESIDE_PLANS: Final = Method("beside-plans", "optima", answers_all, 0.4, 20)
"""One search beside all of them."""

JOINT_PLANS: Final = Method("joint-plans", "no plan", _always, 0.2, 2)
"""A program for whatever the human may do, before all is played that may happen with one who replans."""

NAMES: Final = (*(each.name for each in (*TURNS, ANY_PLAN, BESIDE_PLANS, JOINT_PLANS)), *PARTS)
"""Of all methods and parts that can be left out."""


def require_known(names: tuple[str, ...]) -> None:
    """Raise a UsageError unless all names, less a minus sign, are of methods or of their parts."""
    for name in names:
        if name.removeprefix("-") not in NAMES:
            raise UsageError(f"methods: expected some of {', '.join(NAMES)}, got {name!r}")


# -- the loop


def decide(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """The least objective of a question, by the method that the effort names; ``auto``: by all, in turns.

    Args:
        effort: method, deadline and solver; what is spent is noted there.
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


def decide_without_horizon(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """The least cost of a plan with any number of epochs: no program says that, an exhaustive search does.

    Where anything is due, which may be late without epochs, or waiting costs, they are counted until nothing
    new comes.
    """
    started = perf_counter()
    found = cheapest(question, effort)
    if found.status == "found" and (question.task.due or awake(question.task)):
        found = _exhaustively(question.but(horizon=MAX_EPOCH), effort, plans)
    _note(effort, "without-epochs", found, perf_counter() - started)
    return found


def _decide(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    if question.is_free:
        found = _decide(question.but(rule=FREE), effort, plans)
        window = Window(1, question.horizon + 1)
        return found if found.found is None else replace(found, found=replace(found.found, window=window))
    return _in_turns(question, effort, plans)


def _asked(question: Subproblem, effort: Effort) -> list[Method]:
    """The methods that take turns."""
    if effort.method == "exhaustive" and question.horizon:
        return [each for each in TURNS if each.name == "exhaustive"]
    if effort.method != "auto" or effort.encoding != "automata" or not question.horizon:
        return [each for each in TURNS if each.name == "programs"]
    return [each for each in TURNS if each.applies(question) and uses(each.name)]


def _in_turns(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """Ask one method after the other, again and again, each time for longer; who is left alone has all time.

    Where there are many states, turns are longer from the beginning, since an exhaustive search is the less
    likely to end.
    """
    whole, bounds = effort.deadline, list[int]()
    found = Minimum("undecided", reason="all methods that apply are left out")
    asked, number = _asked(question, effort), int(_begins_long(question))
    while asked:
        for method in tuple(asked):
            assert method.run is not None, "a row of turns"
            last = bool(method.longer) and (asked == [method] or method.is_last(whole, number))
            deadline = whole if last or asked == [method] else method.turn(whole, number)
            given, started = replace(effort, deadline=deadline), perf_counter()
            found = method.run(question.but(deadline=deadline), given, plans)
            _note(effort, method.name, found, perf_counter() - started)
            if found.bound is not None:
                bounds.append(found.bound)
            if found.status != "undecided" or whole.reached() is not None:
                return replace(found, bound=max(bounds, default=None))
            if last or not method.longer or (method.name == "exhaustive" and not deadline.reached()):
                asked.remove(method)  # more time would not help
        number += 1
    return replace(found, bound=max(bounds, default=None))


def _begins_long(question: Subproblem) -> bool:
    """Whether there are many states, as far as the task's variables tell, and not just short windows."""
    bits = sum(log2(max(2, len(variable.facts))) for variable in question.task.variables)
    return bits > _FEW_STATES and not _has_short_windows(question)


def _note(effort: Effort, name: str, found: Minimum, seconds: float) -> None:
    """Keep what a method has made of a question, and tell of it where anybody logs (``verify -v``)."""
    decided = found.status != "undecided"
    effort.attempts.append(Attempt(name, decided, found.states))
    if "logging" in sys.modules:  # it takes longer to load than many a certificate
        import logging

        words = found.status if decided else f"undecided, {found.reason}"
        logging.getLogger("verify").info("%s: %s in %.3f s", name, words, seconds)
