"""Answers to the last questions of a session, and the rest of their plans once the world has moved on.

An answer to the same question from the same state stands: it is given at once where it is proved, and
no later one is worse.  Once the world has moved on, what is left of a plan is what the next search
begins with, if it is a plan of that call at all; and what was proved of the answers stays proved where
that follows from the semantics (serendipity/DECISIONS.md says where, and why).
"""

from collections import OrderedDict
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import fields, replace
from fractions import Fraction
from operator import attrgetter
from typing import Any, Final, NamedTuple

from search import WarmStart
from serendipity.facade.known import Known, read, written
from serendipity.facade.results import named_plan
from serendipity.model import Options, Step, Task, Visible, Window
from serendipity.model.answers.answer import Answer, Improvement
from serendipity.model.numbers import total
from serendipity.model.task.actions import GroundAction, apply
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.gate import is_bound
from serendipity.model.task.passing import epoch_later
from serendipity.model.task.plans import PlanEntry, left_after
from serendipity.model.task.plans_in_time import before_waiting, waited

_Key = tuple[Hashable, ...]
"""A question: all options but limits; candidate goals and what was observed, where goals are not known."""

_OPTIONS: Final = attrgetter(
    *(f.name for f in fields(Options) if f.name not in ("time_limit", "memory_limit"))
)

_MOST: Final = 8
"""Questions at once: modes and discounts that a caller goes back and forth between."""


class Rest(NamedTuple):
    """The rest of a plan, and the options that it was made with."""

    steps: tuple[Step, ...]
    options: Options


class SessionMemory:
    """Knowledge of the last few questions."""

    def __init__(self) -> None:
        self.passed = 0
        """Epochs that are over."""
        self._known: OrderedDict[_Key, Known] = OrderedDict()

    def question(
        self,
        options: Options,
        visible: Visible | None,
        about: Hashable,
        human_plan: tuple[PlanEntry, ...] | None,
    ) -> "RememberedQuestion":
        """A question, and what is known of it, see :class:`RememberedQuestion`."""
        known = self._known.get((*_OPTIONS(options), about))
        if known is not None and known.visible is not visible:
            known = None
        if known is not None and known.human_plan != human_plan:
            warm = known.warm
            if options.windowed and not _is_open(options, warm.window):  # its bound is beside that plan
                warm = replace(warm, bound=None, is_best=False)
            known = known._replace(answer=None, warm=warm)
        return RememberedQuestion(self, options, visible, about, human_plan, known)

    def keep(self, about: Hashable, known: Known) -> None:
        """Remember an answer."""
        key = (*_OPTIONS(known.options), about)
        self._known[key] = known
        self._known.move_to_end(key)
        while len(self._known) > _MOST:
            self._known.popitem(last=False)

    def written(self, task: Task) -> list[dict[str, Any]]:
        """The plans that are left, and what is known of them, as plain values for another process."""
        return [written(task, about, known) for (*_, about), known in self._known.items()]

    def read(self, task: Task, told: Iterable[Mapping[str, Any]]) -> None:
        """Take over what :meth:`written` has told, from the same state.

        Raises:
            KeyError, TypeError, ValueError, UsageError: it has told nothing of the kind.
        """
        for number, value in enumerate(told):
            unsure, known = read(task, value)
            self.keep(number if unsure else None, known)  # a number stands for goals that no question names

    @property
    def rest(self) -> "Rest | None":
        """The rest of the plan of the last answer, if all has gone as planned."""
        if not self._known:
            return None
        known = next(reversed(self._known.values()))
        if not known.warm.is_sure:
            return None
        return Rest(known.warm.steps, known.options)

    def forget(self) -> None:
        """The questions are others now."""
        self._known.clear()

    def moved(self, before: Task, now: Task, *, epochs: int) -> None:
        """The world is in another state.

        Args:
            before: the task from the state before.
            now: the task from the present state.
            epochs: how many have passed, 1 or 0.
        """
        self.passed += epochs
        every, self._known = self._known, OrderedDict()
        for (*_, about), known in every.items():
            self.keep(about, _moved(before, known, now, epochs))


class RememberedQuestion(NamedTuple):
    """A question of a call, and the answers to it that are known.

    Attributes:
        memory: remembers the answers.
        options: as they are asked for.
        visible: what the human sees.
        about: candidate goals and what was observed, where goals are not known.
        human_plan: what the human is going to do, where that is known.
        known: of it, or None.
    """

    memory: SessionMemory
    options: Options
    visible: Visible | None
    about: Hashable
    human_plan: tuple[PlanEntry, ...] | None
    known: Known | None

    @property
    def proved(self) -> Answer | None:
        """The answer, where it is proved."""
        answer = self._answer
        if answer is None or answer.status not in ("optimal", "infeasible"):
            return None
        has_saving = answer.human_plan is not None or answer.cost is None
        if self.known is not None and self.known.options.mode == "composite" and not has_saving:
            return None  # a limit may have come before it was known
        return _told_again(answer)

    @property
    def _answer(self) -> Answer | None:
        return None if self.known is None else self.known.answer

    @property
    def warm(self) -> WarmStart | None:
        """The warm start of the next search, or None."""
        return None if self.known is None else self.known.warm

    def better(self, found: Answer) -> Answer:
        """An answer, or the one that is known where that is better."""
        return found if self._answer is None else _better(self._answer, found, self.options)

    def unless_worse(self, task: Task, answer: Answer, limit: str | None) -> Answer:
        """An answer; none where a limit left nothing but one that is worse than to finish what was begun.

        Args:
            answer: the best one that is known.
        """
        warm = self.warm
        if limit is None or answer.status != "feasible" or warm is None or not warm.is_sure:
            return answer
        return not_now(answer, limit) if is_better(warm, answer, task, self.options) else answer

    def answered(self, task: Task, answer: Answer) -> None:
        """Remember an answer about a task."""
        if answer.status == "unknown":
            return
        answer = answer._replace(realised=answer.realised or None)  # where it is empty, time was up
        warm, plan = WarmStart(), self.human_plan
        if answer.steps is None and self.known is not None:
            warm = self.known.warm  # which can still be finished
        elif answer.ties is None and answer.goals is None and answer.bounds is None:
            bound, is_best = _bound(answer, self.options), answer.status == "optimal"
            warm = WarmStart(answer.steps or (), answer.window, True, bound, is_best, answer.horizon)
            if answer.human_plan is not None:
                plan = named_plan(task, before_waiting(task, answer.human_plan, self.options.head_start))
        self.memory.keep(self.about, Known(self.options, answer, warm, plan, self.visible))


def _told_again(answer: Answer) -> Answer:
    gap = () if answer.cost is None else (Improvement(0.0, answer.objective, answer.lower_bound),)
    searched = None if answer.expanded is None else 0
    counted = None if answer.generated is None else 0
    realised = answer.realised
    if realised is None and answer.goals is not None:
        realised = {}  # they are looked at with the goals' own tasks
    return answer._replace(gap=gap, expanded=searched, generated=counted, realised=realised)


def _better(known: Answer, found: Answer, options: Options) -> Answer:
    """The better one of two answers to one question; bounds on the same objectives hold for both."""
    if found.status in ("optimal", "infeasible"):
        return found
    alike = (known.window is None) == (found.window is None)
    bounds = [answer.lower_bound for answer in (known, found) if answer.lower_bound is not None]
    best = found if found.cost is not None and _rank(found, options) <= _rank(known, options) else known
    if alike and bounds and best.objective is not None:
        best = best._replace(lower_bound=min(max(bounds), best.objective))
    if best is found or best.status == "unknown":
        return best
    again = _told_again(best)
    return again._replace(expanded=found.expanded, generated=found.generated)


def _rank(answer: Answer, options: Options) -> tuple[object, ...]:
    """Of two answers the lesser is better (semantics 3.1, 7)."""
    if answer.bounds is not None:
        return (answer.bounds.upper,)
    assert answer.objective is not None and answer.cost is not None, "it has a plan"
    return options.windowed and not answer.opportunity, answer.objective, answer.cost


def _bound(answer: Answer, options: Options) -> Fraction | None:
    """A lower bound on the objective of all plans, the window included; None where none is known."""
    least = answer.lower_bound
    if least is None or not options.windowed:
        return least
    if answer.saving_alone != 0:
        return None  # the answer may be another one than the best plan
    if answer.window is not None:
        return least
    return least + options.window_weight if least > 0 else None


def _moved(before: Task, known: Known, task: Task, epochs: int) -> Known:
    """The knowledge that is left in another state.

    Where the next epoch of the plan leads to that state, the rest is the rest of a plan; where nothing has
    changed, it is as it was; otherwise it may be a plan by luck.
    """
    warm, options = known.warm, known.options
    asleep = options.head_start
    now = [before.actions[step.action] for step in warm.steps if step.epoch == 1]
    planned = bool(epochs or not asleep) and _leads_to(before, now, task)
    if (task.init, task.script) == (before.init, before.script) and not planned and not (asleep and epochs):
        return known
    passed = 1 if planned else epochs
    steps = (Step(step.epoch - passed, step.action) for step in warm.steps if step.epoch > passed)
    left = WarmStart(tuple(steps), _later(warm.window) if passed else warm.window, planned and warm.is_sure)
    if planned and warm.bound is not None and _stays(before, options, warm):
        paid = sum((before.team_cost(action, options.discount) for action in now), Fraction(0))
        last = warm.horizon - 1 if isinstance(warm.horizon, int) else warm.horizon
        is_best = warm.is_best and (warm.window is None or warm.window.start > 1)
        left = replace(left, bound=warm.bound - paid, is_best=is_best, horizon=last)
    plan = known.human_plan
    if plan is not None and not asleep:
        plan = plan[passed:] if all(isinstance(entry, str) for entry in plan) else left_after(plan, passed)
    options = options.but(head_start=max(0, asleep - epochs))
    return Known(options, None, left, plan, known.visible)


def _leads_to(before: Task, actions: list[GroundAction], task: Task) -> bool:
    """Whether actions lead to the present state, and to what is left of the script."""
    if not before.needs_time:
        return (
            all(one.applicable(before.init) for one in actions) and apply(before.init, *actions) == task.init
        )
    try:
        later = epoch_later(before, actions)
    except BrokenPlanError:
        return False
    return (later.init, later.script) == (task.init, task.script)


def _later(window: Window | None) -> Window | None:
    """A window as it is seen an epoch later; None once it is over."""
    if window is None or window.end == 2:
        return None
    return Window(max(window.start - 1, 1), window.end - 1)


def _stays(task: Task, options: Options, warm: WarmStart) -> bool:
    """Whether every plan from now on, put behind the epoch that went as planned, was a plan before it.

    Then what was no plan's objective is none now, once what the epoch cost is taken off.  The horizon, and
    that the human goes on with the plan that they had, is looked at where that is known.
    """
    if options.max_cost is not None or options.human_model != "omniscient" or options.keep_prefix:
        return False
    if options.waiting_cost or is_bound(task, options):
        return False
    if not options.windowed:
        return options.mode != "communication" or not options.communication_weight
    if task.robot_goal or options.preservation == "state":
        return False
    in_prefix = warm.window is None or warm.window.start > 1
    return in_prefix or _is_open(options, warm.window)


def _is_open(options: Options, window: Window | None) -> bool:
    """Whether any plan fits a window that is open from the start, at no price."""
    free = options.suffix == "replan" and options.preservation == "kernel" and options.max_window is None
    return window is not None and window.start == 1 and free and not options.window_weight


def is_better(rest: WarmStart, answer: Answer, task: Task, options: Options) -> bool:
    """Whether finishing what was begun is better than an answer, and a plan beside the same human plan.

    Args:
        rest: what is left; so far all has gone as planned.
        answer: a feasible one.
        task: from the present state.
    """
    if answer.cost is None or answer.objective is None or answer.human_plan is None:
        return False
    plan, window = [task.actions[i].name for i in answer.human_plan], rest.window
    steps = [(step.epoch, task.actions[step.action]) for step in rest.steps]
    his = [(epoch, action) for epoch, action in steps if task.human in action.participants]
    cost = total(task.team_cost(action, options.discount) for _, action in steps)
    cost += options.waiting_cost * waited(task, ((epoch, action.duration) for epoch, action in his))
    if options.max_cost is not None and cost > answer.cost:
        return False  # it may be more than is allowed
    announced = total(action.cost for _, action in his if action.name not in plan)
    paid = cost + options.communication_weight * announced
    if not options.windowed:
        return paid < answer.objective
    prefix = [action.name for epoch, action in his if window is None or epoch < window.start]
    if not (set(prefix) <= set(plan) if options.keep_prefix else prefix == plan[: len(prefix)]):
        return False
    if not answer.opportunity:  # a better plan of the human's alone is no help
        return cost < answer.cost - (answer.saving_alone or 0)
    length = 0 if window is None else len(window)
    return (paid + options.window_weight * length, cost) < (answer.objective, answer.cost)


def not_now(answer: Answer, limit: str) -> Answer:
    """An answer without its plan, since a limit came before a better one was sure."""
    return Answer(
        "unknown",
        human_plan=answer.human_plan,
        horizon=answer.horizon,
        reason=limit,
        lower_bound=answer.lower_bound,
        baseline=answer.baseline,
        expanded=answer.expanded,
        generated=answer.generated,
    )
