"""Where goals are shared, composite plans bound the answer in every mode, and one of them may be it."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Final

from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Progress, Ties, best_first
from search.engine.paths import path_steps
from search.packed.cost_vector import INFINITE_KEY
from search.packed.parallelise import schedule
from search.spaces.factory import joint_space
from search.spaces.from_composite import Suggestions
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan

if TYPE_CHECKING:  # loaded by the calls that it serves
    from search.classical.team import Sets

_SHARE: Final = 0.4
"""What of the time that is left the joint optimum without a horizon may take, where it may be the answer."""

_MOST: Final = 0.9
"""The same when it goes on, where other ways to an answer have been tried meanwhile."""

_LITTLE: Final = 0.05
"""The same where it only bounds the answer, and for what one composite plan suggests."""

_ALONG: Final = 0.1
"""The same for what the team would do after each epoch of ``pi_H``."""

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
        most_cost: largest scaled cost of an acceptable plan, or None.
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
        most_cost: int | None,
        best: Incumbent,
        progress: Progress,
    ) -> None:
        self._context = context
        self._plan = plan or ()
        self._horizon = horizon
        self._most_cost = most_cost
        self._best = best
        self._progress = progress
        self.decide = horizon is not None and _decide(context)
        self._has_plan = False

    def without_horizon(self) -> None:
        """The joint optimum without a horizon bounds every mode's answer, and may be it.

        Raises:
            LimitReachedError: the deadline of the call came, not only that of its part for this.
        """
        context, team = self._context, self._context.team
        if team is None:
            return
        part = context.deadline.part(_SHARE if self.decide else _LITTLE)
        self._take_all(team.better_plans(context.packed.init, part, self._raise))

    @property
    def is_interrupted(self) -> bool:
        """Whether the joint optimum without a horizon, which may be the answer, is still to be found."""
        team = self._context.team
        return self.decide and team is not None and team.planner.is_open

    def still_without_horizon(self) -> None:
        """The same from where its share of the time ended, if it did, for most of what is left.

        Raises:
            LimitReachedError: the deadline of the call came.
        """
        context, team = self._context, self._context.team
        if self.is_interrupted and team is not None:
            part = context.deadline.part(_MOST)
            self._take_all(team.go_on(context.packed.init, part, self._raise))

    def _take_all(self, plans: "Iterator[Sets]") -> None:
        """Offer plans of the team, the last of which costs least, unless a limit comes."""
        context, team = self._context, self._context.team
        assert team is not None, "they are its plans"
        try:
            for sets in plans:
                self._has_plan = True
                self._offer(schedule(context.task, sets))
        except LimitReachedError:
            context.deadline.check()
            return
        self._raise(team.planner.least if self._has_plan else INFINITE_KEY)

    def along_human_plan(self) -> Iterator[None]:
        """Robots begin at once with what would be best after an epoch of ``pi_H``; if time is limited.

        Where the search without a horizon is to go on, it keeps its planner to itself.

        Raises:
            LimitReachedError: the deadline of the call came.
        """
        context = self._context
        whole, state = context.deadline.part(_ALONG), context.packed.init
        team = context.under(whole).team if self.is_interrupted else context.team
        if team is None or context.deadline.left() is None or not self._plan:
            return
        for number, action in enumerate(self._plan[:-1], 1):
            op = context.packed.op(action)
            state = state & op.keep | op.put
            with suppress(LimitReachedError):
                best = team.best_plan(state, whole.part(2 / (len(self._plan) - number + 1)))
                ops = [context.packed.op(action) for chosen in best or () for action in chosen]
                self._suggest(partial(Suggestions.beside, ops=ops))
            context.deadline.check()
            yield

    def soon_within_horizon(self, limit: int) -> Iterator[None]:
        """Composite plans within ``T`` that a greedy search comes by; if time is limited.

        Args:
            limit: key that they have to beat.

        Raises:
            LimitReachedError: the deadline of the call came.
        """
        context = self._context
        assert self._horizon is not None, "only with a horizon"
        if context.deadline.left() is not None:
            joint = self._incumbent(limit)
            space = joint_space(context, self._horizon, joint.key, _GREED)
            with suppress(LimitReachedError):
                for _ in best_first(space, joint, Progress(), context.deadline.part(_SOON)):
                    self._take(joint)
                    yield
            context.deadline.check()

    def within_horizon(self, limit: int) -> Iterator[None]:
        """A best composite plan within ``T``, which is the answer but for its window and for ties.

        Args:
            limit: key that it has to beat.

        Raises:
            LimitReachedError: the deadline of the call came.
        """
        context = self._context
        assert self._horizon is not None, "only with a horizon"
        joint = self._incumbent(limit)
        progress = Progress(self._progress.bound, told_at=context.deadline.elapsed())
        space = joint_space(context, self._horizon, joint.key)
        shift = context.keys.objective_shift
        for _ in best_first(space, joint, progress, context.deadline, Ties(shift, 0)):
            self._progress.expanded, self._progress.generated = progress.expanded, progress.generated
            self._raise_key(progress.bound)
            self._take(joint)
            yield
        self._raise_key(joint.key >> shift << shift)

    def _incumbent(self, limit: int) -> Incumbent:
        return Incumbent(limit) if self._context.options.windowed else self._best

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
        """What a composite plan suggests may be the best so far in this mode."""
        self._suggest(partial(Suggestions.of, steps=steps))

    def _suggest(self, of: Callable[[Suggestions], Iterator[Incumbent]]) -> None:
        context, options, best = self._context, self._context.options, self._best
        in_order = options.preservation == "kernel" and not options.keep_prefix
        if self._horizon is None or context.weights.announces or not in_order:
            return
        part = context.under(context.deadline.part(_LITTLE))
        suggestions = Suggestions(part, self._plan, self._horizon, self._most_cost, best.key)
        try:
            for found in of(suggestions):
                best.key, best.node, best.end, best.tail = found.key, found.node, found.end, found.tail
        except LimitReachedError:
            context.deadline.check()


def _decide(context: SearchContext) -> bool:
    options = context.options
    if options.max_cost is not None or context.weights.announces:
        return False
    if not options.windowed:
        return True
    free = options.suffix == "replan" and options.preservation == "kernel" and not options.keep_prefix
    plain = not options.window_weight and options.max_window is None
    return free and plain and not context.task.robot_goal
