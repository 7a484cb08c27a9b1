"""From what is known of a call to what is best: what is soon done, then the search of all (semantics 3)."""

from collections.abc import Generator, Iterator
from contextlib import suppress
from typing import Final

from search.short_windows.independent.one_by_one import FIRST, one_by_one
from search.composite import is_for_kernel
from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Node, Progress, Space, Ties, best_first
from search.engine.until import EnoughError, Until, few, risen
from search.joint_plans import JointPlans
from search.packed.cost_vector import INFINITE_KEY
from search.spaces.factory import free_space, window_space
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.task import HumanPlan

_SOON: Final = 0.1
"""What of the time that is left a search for short windows may take, or one for ties."""

_FEW: Final = 1_000
"""Nodes for the sake of a better window for the same objective."""


def is_settled(context: SearchContext, best: Incumbent, progress: Progress) -> bool:
    """Whether the objective can't be beaten, where that is enough (Decisions: objective first)."""
    if not context.distances_say_little or best.key >= INFINITE_KEY:
        return False
    return context.keys.objective(best.key) <= context.keys.objective(progress.bound)


class Improvements:
    """Ways to better plans than the incumbent.

    Args:
        context: of the call.
        plan: ``pi_H``, or None where there is none.
        epochs: ``T``, or None where it is infinite.
        alone: key of leaving the human alone.
        best: the incumbent, which is made better.
        progress: what is known so far, which is brought up to date.

    Attributes:
        most_cost: ``max_cost`` (eq. 11), scaled and rounded down; None where there is none.
    """

    def __init__(
        self,
        context: SearchContext,
        plan: HumanPlan | None,
        epochs: int | None,
        alone: int,
        best: Incumbent,
        progress: Progress,
    ) -> None:
        self._context = context
        self._plan = plan
        self._epochs = epochs
        self._alone = alone
        self._best = best
        self._progress = progress
        self.most_cost = context.keys.most_cost(context.options.max_cost, alone)

    def each(self) -> Iterator[Incumbent]:
        """Each better incumbent, and now and then the same one; on return it is optimal.

        Raises:
            LimitReachedError: the deadline came.
            EnoughError: private distances turn out to say little, and the kernel can go on.
        """
        if self._context.distances_say_little:
            joint = JointPlans(
                self._context, self._plan, self._epochs, self.most_cost, self._best, self._progress
            )
            joint.without_horizon()
            yield self._best
            if not self._is_settled() and (yield from self._in_short_windows()):
                return
            if not self._is_settled():
                for _ in joint.along_human_plan():
                    yield self._best
                yield from self._in_one_epoch()
            if joint.decide and not self._is_settled():
                for _ in joint.soon_within_horizon(self._known()):
                    yield self._best
                joint.still_without_horizon()
                yield self._best
                if not self._is_settled():
                    for _ in joint.within_horizon(self._known()):
                        yield self._best
        if self._is_settled():
            yield from self._settle_ties()
            return
        for _ in best_first(
            self._last_space(), self._best, self._progress, self._context.deadline, self._ties()
        ):
            yield self._best

    def _last_space(self) -> Space[Node, Incumbent]:
        """What is searched at the end; where the kernel can do it, for as long as bounds are exact."""
        space, context = self.space(), self._context
        if context.distances_say_little or not is_for_kernel(context):
            return space
        shift = context.keys.objective_shift
        return Until(space, risen(self._progress, shift, lambda: context.team is not None))

    def _known(self) -> int:
        """The key of the best plan so far, one with a window or not."""
        return min(self._alone, self._best.key)

    def _settle_ties(self) -> Iterator[Incumbent]:
        """Better windows and fewer actions for the same objective, as far as they come soon."""
        context = self._soon()
        with suppress(LimitReachedError):
            for _ in best_first(
                self.space(context), self._best, self._progress, context.deadline, self._ties()
            ):
                yield self._best
        self._context.deadline.check()

    def _ties(self) -> Ties | None:
        return Ties(self._context.keys.objective_shift, _FEW) if self._context.distances_say_little else None

    def _in_short_windows(self) -> Generator[Incumbent, None, bool]:
        """Windows of one epoch, where longer ones can't be better; whether a short search did."""
        best, progress, options = self._best, self._progress, self._context.options
        weight = self._context.keys.epoch_weight
        longer = INFINITE_KEY if options.max_window == 1 else progress.bound + weight
        if not options.windowed or not self._plan or best.key >= longer:
            return False
        with suppress(EnoughError, LimitReachedError):
            context = self._soon()
            space = Until(self.space(context), few(FIRST))
            yield from best_first(space, best, progress, context.deadline, self._ties())
            return True
        self._context.deadline.check()
        yield from self._in_one_epoch_each(longer)
        return False

    def _in_one_epoch_each(self, longer: int) -> Iterator[Incumbent]:
        """Robots by numbers, all agents together if there are few states, robots one by one, all together."""
        from search.short_windows.joint.all_together import AllTogether  # only here: most calls come by without

        assert self._plan is not None and self._epochs is not None, "there is a window"
        asked = self._context, self._plan, self._epochs, self._best, self._progress, longer
        together = AllTogether(*asked)
        alike = one_by_one(*asked, by_numbers=True)
        for ways in (alike, together.soon(), one_by_one(*asked), together.still()):
            yield from ways
            if self._is_settled():
                return

    def _in_one_epoch(self) -> Iterator[Incumbent]:
        """Answers with the shortest window, where longer ones may be better, too; if time is limited."""
        options, plan = self._context.options, self._plan
        if (
            not options.windowed
            or not plan
            or options.max_window == 1
            or self._context.deadline.left() is None
        ):
            return
        if options.window_weight >= self._context.task.cost_of(plan):
            return
        with suppress(LimitReachedError):
            context = self._soon()
            space = self.space(context, max_window=1)
            for _ in best_first(space, self._best, Progress(), context.deadline):
                yield self._best
        self._context.deadline.check()

    def _soon(self) -> SearchContext:
        """The context with a part of the time that is left."""
        return self._context.under(self._context.deadline.part(_SOON))

    def _is_settled(self) -> bool:
        return is_settled(self._context, self._best, self._progress)

    def space(
        self, context: SearchContext | None = None, *, idle: bool = False, max_window: int | None = None
    ) -> Space[Node, Incumbent]:
        """What may happen in the call, as far as it may beat the incumbent.

        Args:
            context: of a part of the call; None for that of all.
            idle: robots do nothing.
            max_window: of the window, in epochs; None for what the options say.
        """
        context, plan, epochs, limit = context or self._context, self._plan, self._epochs, self._best.key
        if not context.options.windowed:
            return free_space(context, epochs, self.most_cost, limit, idle=idle)
        assert plan is not None and epochs is not None, "there is a window"
        return window_space(context, plan, epochs, self.most_cost, limit, idle=idle, max_window=max_window)
