"""One planning call beside ``pi_H``: its incumbents, and what is proved of them (semantics 3)."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from search.bounds.first_interaction import no_team_bound
from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Progress, Space
from search.packed.cost_vector import INFINITE_KEY, CostLayout
from search.spaces.factory import free_space, window_space
from search.spaces.fixed_human_plan import follow_plan
from search.strategies.warm_start import WarmStart
from serendipity.model.answers.answer import Tried
from serendipity.model.keywords import Horizon
from serendipity.model.options import INFINITE
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.task import HumanPlan

if TYPE_CHECKING:
    from search.human.individual_planner import FoundPlan
    from search.short_windows.joint.all_together import AllTogether
    from search.strategies.first_answer import FirstAnswer


class Allowance(NamedTuple):
    """The share of a call that a strategy may take: its deadline, and how many of what it counts."""

    deadline: Deadline
    limit: int


@dataclass(eq=False)
class Call:
    """One planning call: its incumbents and its bound.

    Args:
        given: ``pi_H``, already replayed, or None to predict it.
        least_alone: what an optimal plan of the human's costs; None to find out.
        most: key that a plan beside a given ``pi_H`` has to beat; None where any will do.

    Attributes:
        plan: ``pi_H``; None where there is none, or before it is known.
        is_planned: whether that is known, or not needed.
        epochs: ``T``, or None where it is infinite.
        baseline: the plan that leaves the human alone.
        idle: the best with all robots idle, or with a goal of theirs the baseline.
        unaided: the best in which no robot acts, where an opportunity has to beat that, too.
        best: the incumbent over everything.
        progress: what is known of all plans.
        knows_alone: whether it is known what the human gains alone.
        is_improvable: whether a given plan costs more than an optimal one.
        is_done: whether the incumbent is known to be best in every respect.
        most_cost: ``max_cost`` (eq. 11), scaled and rounded down; None where there is none.
        first: some plan of the human's, found soon, and the answer beside it.
        optimum: the human's canonical plan, in individual mode.
        has_joint_plan: whether a composite plan without a horizon was found.
        timetable: the states beside the human's timetable, as far as they were looked at.
        is_over: whether no strategy is left, or time.
        refusal: why there can be no plan at all, if that is so before anything is searched.
        tried: the strategies so far, in their order.
        limit: what has ended the call, if anything has.
    """

    context: SearchContext
    given: HumanPlan | None
    warm: WarmStart
    least_alone: Fraction | None = None
    most: Callable[[CostLayout], int] | None = None

    def __post_init__(self) -> None:
        self.task = self.context.task
        self.options = self.context.options
        self.keys = self.context.keys
        self.plan: HumanPlan | None = None
        self.is_planned = False
        self.epochs: int | None = None
        self.progress = Progress()
        self.baseline = Incumbent(INFINITE_KEY)
        self.idle = Incumbent(INFINITE_KEY)
        self.unaided = Incumbent(INFINITE_KEY)
        self.best = Incumbent(INFINITE_KEY)
        self.knows_alone = False
        self.is_improvable = False
        self.is_done = False
        self.most_cost: int | None = None
        self.first: FirstAnswer | None = None
        self.optimum: FoundPlan | None = None
        self.has_joint_plan = False
        self.timetable: AllTogether | None = None
        self.is_over = False
        self.refusal: str | None = None
        self.tried: list[Tried] = []
        self.limit: str | None = None

    # -- what is known of the human

    def follow(self, plan: HumanPlan | None, *, optimal: bool) -> None:
        """Go on beside ``pi_H``, or without a plan of theirs; doing nothing is the first incumbent.

        Args:
            plan: ``pi_H``, or None where there is none.
            optimal: whether it is known to cost the human the least.

        Raises:
            UsageError: the horizon is shorter than ``pi_H``, or one is missing.
        """
        self.plan, self.is_planned = plan, True
        horizon = self.horizon
        self.epochs = None if horizon == INFINITE else int(horizon)
        self.context = self.context.for_plan(plan or ())
        self.keys = self.context.keys
        self.knows_alone = optimal
        self._leave_alone()
        self.most_cost = self.keys.most_cost(self.options.max_cost, self.baseline.key)

    def refuse(self, reason: str) -> None:
        """Note that there is no plan at all."""
        self.is_done, self.refusal = True, reason

    def unhelped(self) -> Incumbent:
        """Doing nothing, where it is a plan of the call."""
        # With a goal of the robots' own, leaving the human alone is what a plan with a window is
        # compared with, but it is not itself one that fits every window (semantics 3.1).
        if self.options.windowed and self.task.robot_goal:
            return Incumbent(INFINITE_KEY)
        return replace(self.idle)

    def begin_without_plan(self) -> None:
        """Go on without waiting for ``pi_H``; where it is given, doing nothing is the first incumbent."""
        self.plan, self.is_planned, self.knows_alone = self.given, True, self.given is None
        if self.given is not None:
            self.baseline = Incumbent(self._key_of(self.given))
            self.idle, self.best = replace(self.baseline), replace(self.baseline)

    def compare(self, plan: HumanPlan | None) -> None:
        """Say what robots save, where the answer did not wait for ``pi_H``; None: the human has no plan."""
        self.plan = plan if self.given is None else self.given
        if plan is not None and self.plan is not None:
            self.idle = Incumbent(self._key_of(plan))
            self.baseline = Incumbent(self._key_of(self.plan))
        self.knows_alone = True

    def _key_of(self, plan: HumanPlan) -> int:
        return sum(self.keys.of_action(self.task.actions[action].cost) for action in plan)

    @property
    def horizon(self) -> Horizon:
        """``T``, or ``"inf"``."""
        return horizon_of(self.task, self.options, self.plan)

    def _leave_alone(self) -> None:
        """The human follows ``pi_H``; robots, without the human, see to ``G_R``."""
        plan, epochs = self.plan, self.epochs
        if plan is not None and (epochs is None or len(plan) <= epochs):
            found = Incumbent(INFINITE_KEY)
            follow_plan(self.context, plan, epochs, found)
            self.baseline = found  # what savings are counted from has to be the least there is
        self.idle = replace(self.baseline, key=self.baseline.key + self.window_of_nothing)
        self.best = self.unhelped()
        if self.most is not None and self.most(self.keys) < self.best.key:
            self.best = Incumbent(self.most(self.keys))

    @property
    def window_of_nothing(self) -> int:
        """Key of the window of a plan in which nobody helps: the shortest and latest (semantics 3.1)."""
        if not self.options.windowed or not self.plan or self.epochs is None:
            return 0
        if self.baseline.key == INFINITE_KEY:
            return 0
        return self.keys.epoch_weight + self.keys.of_start(len(self.plan), self.epochs)

    # -- incumbent and bound

    def offer(self, found: Incumbent) -> bool:
        """Whether a plan is the best so far; then it is the incumbent."""
        best = self.best
        if found.key >= best.key:
            return False
        best.key, best.node, best.end, best.tail = found.key, found.node, found.end, found.tail
        return True

    def raise_bound(self, key: int) -> None:
        """Note that no plan has a smaller key."""
        self.progress.bound = max(self.progress.bound, key)

    def raise_joint_bound(self, key: int) -> None:
        """Note that no composite plan has a smaller key: in modes with windows there is one beside it."""
        window = self.keys.epoch_weight if self.options.windowed and self.plan else 0
        self.raise_bound(min(key + window, INFINITE_KEY))

    def finish(self) -> None:
        """Note that the incumbent is the best plan."""
        self.is_done = True
        self.progress.bound = self.best.key

    @property
    def floor(self) -> int:
        """Key that no plan is below, as was known before."""
        known = self.warm.least(self.horizon)
        return 0 if known is None else self.keys.of_objective(known)

    @property
    def is_known_best(self) -> bool:
        """Whether nothing is better than the incumbent, as was known before."""
        shift, floor = self.keys.objective_shift, self.floor if self.warm.is_best else 0
        return bool(floor) and self.best.key >> shift <= floor >> shift

    @property
    def is_settled(self) -> bool:
        """Whether the objective can't be beaten, where that is enough (Decisions: objective first)."""
        shift, best = self.keys.objective_shift, self.best.key
        if best >= INFINITE_KEY or best >> shift > self.progress.bound >> shift:
            return False
        return self.context.distances_say_little

    @cached_property
    def longer(self) -> int:
        """Key that no plan is below whose window is longer than one epoch, by what is known at first."""
        if self.options.max_window == 1:
            return INFINITE_KEY
        return self.progress.bound + self.keys.epoch_weight

    def under(self, deadline: Deadline) -> SearchContext:
        """The context of a part of the call."""
        return self.context if deadline is self.context.deadline else self.context.under(deadline)

    def least(self) -> int:
        """A first bound, before there is any of the robots: what the human has to do themselves."""
        window = self.keys.epoch_weight if self.window_of_nothing else 0
        context, init = self.context, self.context.packed.init
        team = context.team_bound
        return (context.bound(init) if team is no_team_bound else team(init)) + window

    def space(self, deadline: Deadline, limit: int, *, idle: bool = False) -> Space:
        """All plans of the call with a key below a limit; where ``idle``, robots do nothing."""
        context, plan, epochs = self.under(deadline), self.plan, self.epochs
        if not context.options.windowed:
            return free_space(context, epochs, self.most_cost, limit, idle=idle)
        assert plan is not None and epochs is not None, "there is a window"
        return window_space(context, plan, epochs, self.most_cost, limit, idle=idle)
