"""Answers with a window of one epoch, where longer ones can't be better: robots one by one, epoch by epoch.

Until the window the human follows ``pi_H``, and after it they go on alone; so all that robots can do for them
is what they leave behind.  For each epoch this is what each of them can have brought about on its own, put
together in every way, and what the human pays from there on their own, exactly.  Where robots need one
another, each may help itself to what others can have provided by then, for nothing: then it is a lower bound.
"""

from collections.abc import Iterator
from contextlib import suppress
from typing import Final, Protocol

from search.short_windows.independent.alike.robots import CountedRobots
from search.short_windows.independent.alike.tally import Tally, tally
from search.short_windows.independent.conditions import are_apart
from search.short_windows.independent.one_window import RobotsApart
from search.short_windows.independent.provision import Provision, by_others, provisions
from search.short_windows.independent.timeline import TooManyStatesError
from search.short_windows.independent.window import ACTION, Window
from search.call.context import SearchContext
from search.engine.best_first import Incumbent
from search.packed.cost_vector import FAR, INFINITE_KEY
from search.packed.operators import Operator, split
from search.packed.packed_task import PackedTask
from search.spaces.from_composite import Suggestions
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.task import HumanPlan

_SOON: Final = 0.3
"""What of the time that is left robots may take who don't rely on one another."""

_WORTH: Final = 4
"""What a window promises is tried out at once if it is one part in so many of what can be hoped for."""

_TRIALS: Final = 20
"""Of what costs least in an epoch so many are tried out, until one can be done."""


class ShortWindows:
    """Plans with a window of one epoch, by the epoch of the window.

    Args:
        context: of the call; its mode has windows after which the human replans.
        plan: ``pi_H``.
        horizon: ``T``.
        best: the call's incumbent, which is made better.
        counted: how what robots do is counted, where they are told by numbers; else None.
    """

    def __init__(
        self,
        context: SearchContext,
        plan: HumanPlan,
        horizon: int,
        best: Incumbent,
        counted: Tally | None = None,
    ) -> None:
        self._context = context
        self._plan = plan
        self._horizon = horizon
        self._best = best
        self._counted = counted
        self._through_all: _Pass | None = None

    @property
    def bound(self) -> int:
        """No plan with a window of one epoch has a smaller key, but the incumbent."""
        return 0 if self._through_all is None else self._through_all.bound

    def answers(self) -> Iterator[None]:
        """Yield whenever the incumbent has become better; in the end the bound is as good as it gets.

        Raises:
            LimitReachedError: the deadline came, or there are too many states; what is known by then is kept.
        """
        if self._counted is None:
            yield from self._one_by_one()
        else:
            robots = CountedRobots(self._context, self._plan, self._counted, self._amount)
            yield from self._through(self._context, robots)

    def _one_by_one(self) -> Iterator[None]:
        """What robots come to who don't rely on one another first: most of that can be done."""
        context, packed = self._context, self._context.packed
        steps = [packed.op(action) for action in self._plan]
        provided = provisions(packed, steps, len(steps), context.deadline)
        robots = sorted({op.agents for op in packed.others})
        others = {robot: by_others(provided, robot) for robot in robots}
        if any(_relies(packed, robot, others[robot]) for robot in robots):
            soon = context.under(context.deadline.part(_SOON))
            with suppress(LimitReachedError):
                nobody = RobotsApart(soon, steps, dict.fromkeys(robots, Provision()), self._amount)
                yield from self._pass(soon, nobody).answers()
            context.deadline.check()
        yield from self._through(context, RobotsApart(context, steps, others, self._amount))

    def _through(self, context: SearchContext, robots: "Robots") -> Iterator[None]:
        """All windows, as a bound as well."""
        self._through_all = self._pass(context, robots)
        yield from self._through_all.answers()

    def _pass(self, context: SearchContext, robots: "Robots") -> "_Pass":
        return _Pass(context, self._plan, self._horizon, self._best, robots)

    def _amount(self, op: Operator) -> int:
        return self._context.weights.scaled_cost(op) * ACTION + 1


def _relies(packed: PackedTask, robot: int, others: Provision) -> bool:
    """Whether a robot could make use of what others can provide."""
    fields = {field & -field: field for field in packed.fields}
    for op in packed.others:
        if op.agents == robot:
            needs = ((field, op.need & field) for field in split(op.need_mask, fields))
            if any(value in others for value in needs):
                return True
            if any(field == other for field, _ in op.forbidden for other, _ in others):
                return True
    return False


class Robots(Protocol):
    """Robots beside the human's plan, epoch by epoch."""

    def window(self, base: int, start: int, limit: int) -> Window:
        """What they can have left behind by the end of a window in the next epoch.

        Args:
            base: the packed state before it without robots.
            start: key of what comes before it, and of the window.
            limit: key from which on nothing is of interest.

        Raises:
            LimitReachedError: there is too much, or the deadline came.
        """

    def follow(self, step: Operator, most: int) -> None:
        """One more epoch of the human's plan.

        Args:
            step: of the human's plan.
            most: nothing that costs as much is of interest.

        Raises:
            LimitReachedError: there is too much, or the deadline came.
        """


class _Pass:
    """Windows of one epoch, one after another; arguments as above.

    Args:
        robots: what they can do.
    """

    def __init__(
        self, context: SearchContext, plan: HumanPlan, horizon: int, best: Incumbent, robots: Robots
    ) -> None:
        self._context = context
        self._plan = plan
        self._horizon = horizon
        self._best = best
        self._robots = robots
        self._windows: list[Window] = []
        self._ahead = 0

    @property
    def bound(self) -> int:
        """No plan has a smaller key, but the incumbent, if robots take nothing else from others."""
        return min([self._ahead, *(window.bound for window in self._windows)])

    def answers(self) -> Iterator[None]:
        """See :meth:`ShortWindows.answers`.

        All windows are looked at before any of them is gone through: a good incumbent saves most of that.
        """
        best = self._best
        with suppress(TooManyStatesError):
            for window in self._each():
                hoped = best.key - window.bound
                if hoped * _WORTH < best.key - self._ahead or not window.is_open(best.key):
                    continue
                if self._tries(window, window.look(best.key)):
                    yield
        for window in sorted(self._windows, key=lambda window: window.bound):
            trials = 0
            while trials < _TRIALS and window.is_open(best.key):
                place = window.look(best.key)
                if self._tries(window, place):
                    yield
                elif place is not None:
                    trials += 1

    def _each(self) -> Iterator[Window]:
        """Windows of one epoch, the earliest first."""
        context, packed, best = self._context, self._context.packed, self._best
        base, spent = packed.init, context.keys.epoch_weight
        for epoch, step in enumerate(map(packed.op, self._plan), 1):
            self._ahead = spent
            if spent >= best.key:
                return
            start = spent + context.keys.of_start(epoch, self._horizon)
            self._windows.append(self._robots.window(base, start, best.key))
            yield self._windows[-1]
            spent += context.weights.team(step)
            if epoch < len(self._plan) and spent < best.key:
                self._ahead = spent
                self._robots.follow(step, context.amount_from(best.key - spent, FAR))
            base = base & step.keep | step.put
        self._ahead = INFINITE_KEY

    def _tries(self, window: Window, place: int | None) -> bool:
        """Whether robots can leave something behind together, and it is the best so far."""
        best = self._best
        ways = None if place is None else window.ways(place)
        if ways is None:
            return False
        suggestions = Suggestions(self._context, self._plan, self._horizon, None, best.key)
        improved = False
        for found in suggestions.on_time(ways):
            best.key, best.node, best.end, best.tail = found.key, found.node, found.end, found.tail
            improved = True
        return improved


def short_windows(
    context: SearchContext, plan: HumanPlan, horizon: int, best: Incumbent, *, by_numbers: bool = False
) -> ShortWindows | None:
    """Plans with a window of one epoch, robots one by one; None where they can't be looked at so.

    Args:
        context: of the call.
        plan: ``pi_H``.
        horizon: ``T``.
        best: the call's incumbent.
        by_numbers: robots are told by numbers.

    Raises:
        LimitReachedError: the deadline came.
    """
    options, packed = context.options, context.packed
    plain = options.suffix == "replan" and options.preservation == "kernel" and not options.keep_prefix
    if not plain or options.max_cost is not None or context.task.robot_goal or not packed.others:
        return None
    counted = tally(packed, context.relevant, context.deadline) if by_numbers else None
    if context.weights.announces or (by_numbers and counted is None):
        return None
    if not are_apart(packed, context.deadline, strict=options.strict):
        return None
    if not _fit_words(context, plan, best):
        return None
    return ShortWindows(context, plan, horizon, best, counted)


def _fit_words(context: SearchContext, plan: HumanPlan, best: Incumbent) -> bool:
    """Whether what robots pay up to a window, the human's landmarks, and what is of interest fit words."""
    price, packed = context.weights.scaled_cost, context.packed
    robots = (max(map(price, packed.others)) + 1) * (len(plan) + 1) * len(context.task.robots)
    human = sum(map(price, packed.own)) + len(packed.own)
    return max(robots, human) * ACTION < FAR > context.amount_from(best.key, FAR)
