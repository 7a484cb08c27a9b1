"""For each single window: the least the human pays, and the least the team pays (semantics 3.2).

One search per window and objective, in the space of ``search.spaces.fixed_window``.  What the
human pays comes first in the one objective and what the team pays in the other, so either
can be as small as any plan that fits the window makes it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import count

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.best_first import Incumbent, Progress, best_first
from search.engine.paths import plan_steps, whole_plan
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operators import Operator
from search.spaces.fixed_window import FixedWindow, Weighed
from search.strategies.call import Call
from search.strategies.warm_start import WarmStart
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import Step, Window
from serendipity.model.task.task import HumanPlan


@dataclass(frozen=True, slots=True)
class WindowOutcome:
    """The least costs of plans that fit one window.

    Attributes:
        human_cost: least undiscounted cost of what the human takes part in, or None
            where no plan fits the window.
        team_cost: least cost for the team, discounted, or None.
        steps: the plan that attains ``human_cost``, the cheapest of these for the team.
    """

    window: Window
    human_cost: Fraction | None
    team_cost: Fraction | None
    steps: tuple[Step, ...] | None


@dataclass(frozen=True, slots=True)
class Interruptions:
    """The report on every window.

    Attributes:
        human_plan: ``pi_H``.
        baseline: what doing nothing for the human costs the team, or None if that is
            impossible (robots that can't reach their own goal).
        windows: all of them, examined when they are asked for: the largest first, for its plans
            are no worse than any other's (under ``preservation="kernel"``).  Asking raises
            ``LimitReachedError`` when the deadline has run out.
    """

    human_plan: HumanPlan
    horizon: int
    baseline: Fraction | None
    windows: Iterator[WindowOutcome]


def interruptions(
    prepared: PreparedTask,
    options: Options,
    *,
    human_plan: HumanPlan | None = None,
    deadline: Deadline | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> Interruptions | None:
    """The report of semantics 3.2, or None where the human has no plan alone.

    Args:
        options: discount, horizon, suffix, preservation and interference count.
        human_plan: ``pi_H``, already replayed, or None to predict it.
        on_progress: called with the number of searches done, and of all.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``.
        LimitReachedError: the deadline ran out before ``pi_H`` was known.
    """
    asked = options.but(
        mode="serendipity", max_cost=None, max_window=None, keep_prefix=False, window_weight=0
    )
    context = SearchContext(prepared, asked, deadline or Deadline())
    plan = human_plan
    if plan is None:
        optimal = context.canonical_plan()
        if optimal is None:
            return None
        plan = optimal.actions
    call = Call(context, human_plan, WarmStart())
    call.follow(plan, optimal=human_plan is None)
    horizon, key = int(call.horizon), call.baseline.key
    baseline = None if key >= INFINITE_KEY else call.keys.cost(key)
    # Idle robots fit every window (semantics 3.1), unless they have a goal.
    idling = INFINITE_KEY if prepared.task.robot_goal else key
    windows = _examined(call.context, plan, horizon, idling, on_progress)
    return Interruptions(plan, horizon, baseline, windows)


def _examined(
    context: SearchContext,
    plan: HumanPlan,
    horizon: int,
    idling: int,
    on_progress: Callable[[int, int], None] | None,
) -> Iterator[WindowOutcome]:
    """Outcomes of all windows, those first that say most of the others."""
    if not plan:
        return
    windows = len(plan) * (horizon + 1) - len(plan) * (len(plan) + 1) // 2
    objectives = [
        _Objective(context, Weighed(context, plan, horizon, weight, robots, idling), idling)
        for weight, robots in (_human_first(context), (context.weights.team, context.weights.robots))
    ]
    done, keys = count(1), context.keys
    for window in _ordered(len(plan), horizon):
        context.deadline.check()  # where neither objective has anything left to search
        best = []
        for objective in objectives:
            best.append(objective.best(window))
            if on_progress is not None:
                on_progress(next(done), 2 * windows)
        human, team = best
        if human.key >= INFINITE_KEY:
            yield WindowOutcome(window, None, None, None)
            continue
        steps = plan_steps(plan) if human.node is None else whole_plan(human)
        yield WindowOutcome(window, keys.objective(human.key), keys.objective(team.key), steps)


def _human_first(context: SearchContext) -> tuple[Callable[[Operator], int], list[int]]:
    """Weights under which what the human pays is the objective, and what the team pays comes next."""
    keys, human_bit = context.keys, context.packed.human_bit
    robots = [weight & (1 << keys.objective_shift) - 1 for weight in context.weights.robots]

    def weight(op: Operator) -> int:
        return context.weights.team(op) if op.agents & human_bit else robots[op.cost]

    return weight, robots


def _ordered(starts: int, horizon: int) -> Iterator[Window]:
    """All windows: first those that reach to either end, each of which bounds a row or a column of the rest.

    Args:
        starts: length of ``pi_H``, at least 1: a window begins no later.
    """
    last = horizon + 1
    yield Window(1, last)
    yield from (Window(start, last) for start in range(starts, 1, -1))
    yield from (Window(1, end) for end in range(2, last))
    for length in range(1, horizon):
        for start in range(2, min(starts, last - length - 1) + 1):
            yield Window(start, start + length)


class _Objective:
    """The best plan of each window under some weights.

    A plan that fits a window fits every larger one, as long as the suffix only asks for what
    is left to do.  So a window is at least as good as those inside it, and at most as good as
    those around it; where the two meet there is nothing to search.
    """

    def __init__(self, context: SearchContext, weighed: Weighed, idle: int) -> None:
        self._deadline = context.deadline
        self._weighed = weighed
        self._idle = idle
        self._nested = context.options.preservation == "kernel"
        self._found: dict[Window, Incumbent] = {}

    def best(self, window: Window) -> Incumbent:
        """The best plan of a window; an infinite key where none fits."""
        least, best = self._around(window), replace(self._inside(window))
        if best.key > least:
            space = FixedWindow(self._weighed, window)
            for _ in best_first(space, best, Progress(), self._deadline):
                if best.key <= least:
                    break
        self._found[window] = best
        return best

    def _inside(self, window: Window) -> Incumbent:
        """The best of the windows inside that are known already."""
        best = Incumbent(self._idle)
        if self._nested and len(window) > 1:
            smaller = (Window(window.start, window.end - 1), Window(window.start + 1, window.end))
            for known in filter(None, map(self._found.get, smaller)):
                best = min(best, known, key=lambda incumbent: incumbent.key)
        return best

    def _around(self, window: Window) -> int:
        """No plan of the window has a smaller key."""
        if not self._nested:
            return 0
        larger = (
            Window(1, self._weighed.horizon + 1),
            Window(window.start, self._weighed.horizon + 1),
            Window(1, window.end),
        )
        return max((known.key for known in filter(None, map(self._found.get, larger))), default=0)
