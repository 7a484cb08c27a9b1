"""For each single window: the least the human pays, and the least the team pays (SPEC 3.2).

The search is that of ``search.windowed`` with both ends of the window fixed.  What
the human pays comes first in the one objective and what the team pays in the other,
so either can be as small as any plan that fits the window makes it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction

from search.best_first import Incumbent, Node, Progress, best_first
from search.clock import Clock
from search.encoding import Op, applicable
from search.keys import INFINITE_KEY
from search.labels import Labels
from search.outcome import path_steps, plan_steps
from search.planner import solve
from search.successors import NOTHING, Option, Successors
from search.suffix import Suffix
from search.tables import Tables
from search.windows import suffix_rule
from serendipity.model.options import Options
from serendipity.model.plans import Step, Window
from serendipity.model.task import HumanPlan, Task


@dataclass(frozen=True, slots=True)
class WindowOutcome:
    """What is possible in one window.

    Attributes:
        window: the window.
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
    """What is possible in every window.

    Attributes:
        human_plan: ``pi_H``.
        horizon: ``T``.
        baseline: what doing nothing for the human costs the team, or None if that is
            impossible (robots that can't reach their own goal).
        windows: ascending.
    """

    human_plan: HumanPlan
    horizon: int
    baseline: Fraction | None
    windows: tuple[WindowOutcome, ...]


def interruptions(
    task: Task,
    options: Options,
    *,
    human_plan: HumanPlan | None = None,
    clock: Clock | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> Interruptions | None:
    """The report of SPEC 3.2, or None where the human has no plan alone.

    Args:
        task: the task.
        options: discount, horizon, suffix, preservation and interference count.
        human_plan: ``pi_H``, already replayed, or None to predict it.
        clock: deadline and cancellation.
        on_progress: called with the number of searches done, and of all.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``.
        OutOfTimeError: the clock ran out.
    """
    clock = clock or Clock()
    asked = options.but(
        mode="serendipity", max_cost=None, max_window=None, keep_prefix=False, window_weight=0
    )
    *_, idle = solve(task, asked.but(max_window=1), human_plan=human_plan, clock=clock)
    plan = idle.human_plan
    if plan is None:
        return None
    horizon = int(idle.horizon or 0)
    tables = Tables(task, asked, clock).for_plan(plan)
    starts = range(1, len(plan) + 1)
    windows = [Window(start, end) for start in starts for end in range(start + 1, horizon + 2)]
    count = _Count(2 * len(windows), on_progress)
    human = _Objective(tables, plan, horizon, _human_first(tables), count).best(windows)
    team = _Objective(tables, plan, horizon, tables.weights.team, count).best(windows)
    found = (_outcome(tables, plan, window, human[window], team[window]) for window in windows)
    return Interruptions(plan, horizon, idle.baseline, tuple(found))


def _human_first(tables: Tables) -> Callable[[Op], int]:
    """Weights under which what the human pays is the objective, and what the team pays comes next."""
    keys, human_bit = tables.keys, tables.encoding.human_bit
    cost_only = (1 << keys.objective_shift) - 1

    def weight(op: Op) -> int:
        full = tables.weights.team(op)
        return full if op.agents & human_bit else full & cost_only

    return weight


def _outcome(
    tables: Tables, plan: HumanPlan, window: Window, human: Incumbent, team: Incumbent
) -> WindowOutcome:
    if human.key >= INFINITE_KEY:
        return WindowOutcome(window, None, None, None)
    if human.node is None:
        steps = plan_steps(plan)
    else:
        steps = path_steps(human.node) + plan_steps(human.tail, human.end)
    keys = tables.keys
    return WindowOutcome(window, keys.objective(human.key), keys.objective(team.key), steps)


class _Count:
    """Tells how many searches are done."""

    def __init__(self, total: int, report: Callable[[int, int], None] | None) -> None:
        self._done = 0
        self._total = total
        self._report = report

    def one_more(self) -> None:
        """A search is done."""
        self._done += 1
        if self._report is not None:
            self._report(self._done, self._total)


class _Objective:
    """The best plan of each window under some weights.

    A plan that fits a window fits every larger one, as long as the suffix only asks for what
    is left to do.  So a window is at least as good as those inside it, and at most as good as
    those around it; where the two meet there is nothing to search.  The windows that reach to
    either end come first, since each of them bounds a row or a column of the rest.
    """

    def __init__(
        self, tables: Tables, plan: HumanPlan, horizon: int, weight: Callable[[Op], int], count: _Count
    ) -> None:
        self._tables = tables
        self._count = count
        self._plan = plan
        self._horizon = horizon
        self._successors = Successors(tables.encoding, weight, strict=tables.options.strict)
        self._suffix = suffix_rule(tables, plan)
        self._nested = tables.options.preservation == "kernel"
        self._found: dict[Window, Incumbent] = {}

    def best(self, windows: list[Window]) -> dict[Window, Incumbent]:
        """By window; an infinite key where no plan fits."""
        last = self._horizon + 1
        early = [Window(1, end) for end in range(2, last)]
        late = [Window(start, last) for start in range(len(self._plan), 1, -1)]
        rest = sorted(windows, key=lambda window: (len(window), window))
        for window in (Window(1, last), *late, *early, *rest) if windows else ():
            if window not in self._found:
                self._found[window] = self._best(window)
                self._count.one_more()
        return self._found

    def _best(self, window: Window) -> Incumbent:
        known, least = self._inside(window), self._around(window)
        if known.key <= least:
            return known
        best = Incumbent(known.key, known.node, known.end, known.tail)
        space = _FixedWindow(self._tables, self._plan, self._horizon, window, self._successors, self._suffix)
        for _ in best_first(space, best, Progress(), self._tables.clock):
            if best.key <= least:
                break
        return best

    def _idle(self) -> Incumbent:
        """``pi_H`` with robots idle, which fits every window (SPEC 3.1)."""
        if self._tables.task.robot_goal:
            return Incumbent(INFINITE_KEY)
        return Incumbent(sum(option.weight for _, option in self._tables.followed(self._plan)))

    def _inside(self, window: Window) -> Incumbent:
        """The best of the windows inside that are known already."""
        best = self._idle()
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
            Window(1, self._horizon + 1),
            Window(window.start, self._horizon + 1),
            Window(1, window.end),
        )
        return max((known.key for known in filter(None, map(self._found.get, larger))), default=0)


class _FixedWindow:
    """The search space of plans that fit one window.

    Only the window's end is left open to waiting: a node inside it stands for everybody
    waiting until the end, too.
    """

    def __init__(
        self,
        tables: Tables,
        plan: HumanPlan,
        horizon: int,
        window: Window,
        successors: Successors,
        suffix: Suffix,
    ) -> None:
        self._tables = tables
        self._window = window
        self._left = horizon + 1 - window.end
        self._steps = tables.followed(plan)[: window.start - 1]
        self._successors = successors
        self._suffix = suffix
        self._prefix: dict[tuple[int, int], int] = {}
        self._labels = Labels()
        self._bounds = self._bounds_along()

    def _bounds_along(self) -> list[int]:
        """Least key increment after each epoch of the prefix, in which he follows ``pi_H``."""
        state = self._tables.encoding.init
        for op, _ in self._steps:
            state = state & op.keep | op.put
        bounds = [self._tables.bound(state)]
        for _, option in reversed(self._steps):
            bounds.append(bounds[-1] + option.weight)
        return bounds[::-1]

    def roots(self) -> Iterator[tuple[int, Node]]:
        """The initial state."""
        initial = self._tables.encoding.init
        self._remember(0, initial, 0)
        yield self._bounds[0], Node(0, 0, initial, 0, 0, None, ())

    def alive(self, node: Node) -> bool:
        """Whether no better node makes this one superfluous."""
        if node.epoch < len(self._steps):
            return self._prefix[node.epoch, node.state] == node.key
        return self._labels.alive(node.state, node.epoch, node.key)

    def expand(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Successors; a node of the window is offered to ``best`` as the last in which anybody acts."""
        if node.epoch < len(self._steps):
            op, option = self._steps[node.epoch]
            if applicable(op, node.state):
                yield from self._children(node, option, best)
            return
        self._end(node, best)
        if node.epoch + 1 < self._window.end:
            state = node.state
            for part in (NOTHING, *self._successors.human(state), *self._successors.joint(state)):
                yield from self._children(node, part, best)

    def _children(self, node: Node, part: Option, best: Incumbent) -> Iterator[tuple[int, Node]]:
        epoch = node.epoch + 1
        for option in self._successors.with_robots(part, node.state):
            state = node.state & option.keep | option.put
            key = node.key + option.weight
            inside = epoch >= len(self._steps)
            bound = key + (self._tables.bound(state) if inside else self._bounds[epoch])
            if bound < best.key and self._remember(epoch, state, key):
                yield bound, Node(key, epoch, state, 0, 0, node, option.actions)

    def _remember(self, epoch: int, state: int, key: int) -> bool:
        """Whether the state was not reached as cheaply before: in that epoch, or in the window by then."""
        if epoch >= len(self._steps):
            return self._labels.add(state, epoch, key)
        known = self._prefix.get((epoch, state))
        if known is not None and known <= key:
            return False
        self._prefix[epoch, state] = key
        return True

    def _end(self, node: Node, best: Incumbent) -> None:
        limit = best.key - node.key
        rest = self._suffix.key(node.state, self._left, self._window.start, limit)
        if rest < limit:
            best.key, best.node, best.end = node.key + rest, node, self._window.end
            best.tail = self._suffix.actions(node.state, self._left, self._window.start)
