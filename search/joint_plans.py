"""Where goals are shared, composite plans bound the answer in every mode, and one of them may be it."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Final

from search.classical.problem import NO_PLAN
from search.context import SearchContext
from search.engine.best_first import Incumbent, Progress, best_first
from search.engine.paths import path_steps
from search.packed.cost_vector import INFINITE_KEY
from search.packed.parallelise import schedule
from search.spaces.factory import joint_space
from search.spaces.from_composite import as_incumbent
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan

_SHARE: Final = 0.4
"""What of the time that is left the joint optimum without a horizon may take, where it may be the answer."""

_LITTLE: Final = 0.05
"""The same where it only bounds the answer."""

_SOON: Final = 0.2
"""The same for a greedy search, for the sake of an answer on the way."""

_GREED: Final = 5
"""What its bound counts for."""


class JointPlans:
    """Composite plans of a call's task, and what they say of its answer.

    Args:
        context: of the call.
        plan: ``pi_H``; None or none of its actions where there is none.
        horizon: ``T``, or None.
        best: the call's incumbent, which is made better.
        progress: the call's; its bound is raised.

    Attributes:
        decide: whether every composite plan within ``T`` keeps the mode's rules, and its cost is its
            objective.
    """

    def __init__(
        self,
        context: SearchContext,
        plan: HumanPlan | None,
        horizon: int | None,
        best: Incumbent,
        progress: Progress,
    ) -> None:
        self._context = context
        self._plan = plan or ()
        self._horizon = horizon
        self._best = best
        self._progress = progress
        self.decide = horizon is not None and _decide(context)

    def without_horizon(self) -> None:
        """The joint optimum without a horizon bounds every mode's answer, and may be it.

        Raises:
            LimitReachedError: the deadline of the call came, not only that of its part for this.
        """
        context, team = self._context, self._context.team
        if team is None:
            return
        init, task = context.packed.init, context.task
        part = context.deadline.part(_SHARE if self.decide else _LITTLE)
        try:
            first = team.first_plan(init, part)
            if first is not None:
                self._offer(schedule(task, first))
            best = team.best_plan(init, part, self._raise)
        except LimitReachedError:
            context.deadline.check()
            return
        self._raise(NO_PLAN if best is None else team.planner.least)
        if best is not None:
            self._offer(schedule(task, best))

    def within_horizon(self, limit: int) -> Iterator[None]:
        """The best composite plan within ``T``, which is the answer but for its window.

        Args:
            limit: key that it has to beat.

        Raises:
            LimitReachedError: the deadline of the call came.
        """
        context = self._context
        assert self._horizon is not None, "only with a horizon"
        joint = Incumbent(limit) if context.options.windowed else self._best
        if context.deadline.left() is not None:
            space = joint_space(context, self._horizon, joint.key, _GREED)
            with suppress(LimitReachedError):
                for _ in best_first(space, joint, Progress(), context.deadline.part(_SOON)):
                    self._take(joint)
                    yield
        context.deadline.check()
        progress = Progress(self._progress.bound, told_at=context.deadline.elapsed())
        space = joint_space(context, self._horizon, joint.key)
        for _ in best_first(space, joint, progress, context.deadline):
            self._progress.expanded, self._progress.generated = progress.expanded, progress.generated
            self._raise_key(progress.bound)
            self._take(joint)
            yield
        self._raise_key(joint.key)

    def _raise(self, amount: int) -> None:
        """No composite plan costs the team less than an amount."""
        self._raise_key(self._context.amount_key(amount))

    def _raise_key(self, key: int) -> None:
        window = self._context.keys.epoch_weight if self._context.options.windowed and self._plan else 0
        self._progress.bound = max(self._progress.bound, min(key + window, INFINITE_KEY))

    def _take(self, joint: Incumbent) -> None:
        if joint is not self._best and joint.node is not None:
            self._offer(path_steps(joint.node))

    def _offer(self, steps: Sequence[Step]) -> None:
        """A composite plan, which may be the best so far in this mode."""
        if not self.decide or self._horizon is None:
            return
        found, best = as_incumbent(self._context, steps, self._plan, self._horizon), self._best
        if found is not None and found.key < best.key:
            best.key, best.node, best.end, best.tail = found.key, found.node, found.end, found.tail


def _decide(context: SearchContext) -> bool:
    options = context.options
    if options.max_cost is not None or context.weights.announces:
        return False
    if not options.windowed:
        return True
    free = options.suffix == "replan" and options.preservation == "kernel" and not options.keep_prefix
    plain = not options.window_weight and options.max_window is None
    return free and plain and not context.task.robot_goal
