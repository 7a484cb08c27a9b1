"""People who can be plugged into an execution in time (see :mod:`serendipity.execution.persons`)."""

from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import TYPE_CHECKING

from serendipity.execution.clock.world import WorldInTime
from serendipity.facade.person.follower import Follower
from serendipity.facade.person.sight import Sight
from serendipity.facade.person.ways import Ways
from serendipity.model import Deadline, HumanPlan, Options, PlanStep, Task, UsageError
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.execution import variant_named
from serendipity.model.task.passing import at_work, epoch_later
from serendipity.model.task.task import canonical_name

if TYPE_CHECKING:
    from serendipity.execution.persons import Moment


class Free:
    """Somebody observant: they go on with what they are at, and look up when they are free.

    Args:
        task: where they begin.
        dice: draw which of their optimal plans they follow; None: the canonical one.
        local: whether they see only what is where they are, and may be wrong about the rest.
    """

    def __init__(self, task: Task, dice: Random | None = None, *, local: bool = False) -> None:
        self._task = task
        self._ways = Ways(Options())
        self._mind = Follower(self._ways, dice, Sight(task) if local else None)

    @property
    def plan(self) -> HumanPlan | None:
        """See :class:`serendipity.execution.Person`."""
        return self._mind.plan(self._task)

    def choose(self, moment: "Moment") -> str | None:
        """See :class:`serendipity.execution.Person`."""
        now, mind = _now(moment), self._mind
        choice = mind.choose(now, moment.offers, Deadline())
        if isinstance(choice, PlanStep):
            mind.joined()
            joint = variant_named(now, choice.action, choice.agents, now.init)
            mind.expects([now.actions[joint]])
            return choice.action
        world = WorldInTime(now, Fraction(0), strict=False)
        own = None if choice is None else world.his(choice)
        if own is not None and mind.sight is not None and not world.applicable(own):
            mind.failed(now.actions[own], now)
            mind.expects(())
            return choice
        mind.passed(choice)
        mind.expects(() if own is None else (now.actions[own],))
        return choice


class ToldInTime(Free):
    """Does what the robots' plan says; without one, what somebody observant does."""

    def choose(self, moment: "Moment") -> str | None:
        """See :class:`serendipity.execution.Person`."""
        if not moment.planned:
            return super().choose(moment)
        self._mind.rest = None
        return moment.wish

    @property
    def plan(self) -> HumanPlan | None:
        """See :class:`serendipity.execution.Person`."""
        return None


class Unsteady(Free):
    """Like somebody observant; but when free they do with some probability something else that they can.

    Args:
        probability: of something else, in each epoch in which they are free.
        dice: for that, and, with ``drawn``, for which of their optimal plans they follow.
    """

    def __init__(self, task: Task, probability: float, dice: Random, *, drawn: bool) -> None:
        super().__init__(task, dice if drawn else None)
        self._probability = probability
        self._chance = dice

    def choose(self, moment: "Moment") -> str | None:
        """See :class:`serendipity.execution.Person`."""
        now = _now(moment)
        stray = self._chance.random() < self._probability
        if not stray or now.human in at_work(now):
            return super().choose(moment)
        self._mind.rest = None
        return self._chance.choice(
            [None, *(now.actions[i].name for i in now.human_actions if self._way_back(now, i))]
        )

    def _way_back(self, now: Task, action: int) -> bool:
        if not now.actions[action].applicable(now.init):
            return False
        try:
            later = epoch_later(now, [now.actions[action]])
        except BrokenPlanError:
            return False
        return self._ways.of(later, Deadline()) is not None


class Record(Free):
    """Does what was written down, one thing after another, then goes on like somebody observant.

    Args:
        actions: names, ``noop`` for an epoch of waiting.
    """

    def __init__(self, task: Task, actions: Sequence[str]) -> None:
        super().__init__(task)
        self._left = [canonical_name(name) for name in actions]

    @property
    def plan(self) -> HumanPlan | None:
        """See :class:`serendipity.execution.Person`."""
        return None if self._left else super().plan

    def choose(self, moment: "Moment") -> str | None:
        """See :class:`serendipity.execution.Person`."""
        if not self._left:
            return super().choose(moment)
        if self._task.human in at_work(_now(moment)):
            return None
        name = self._left.pop(0)
        return None if self._task.waits(name) and name not in self._task.named else name


def _now(moment: "Moment") -> Task:
    """The task as it stands."""
    if moment.now is None:
        raise UsageError("moment: expected one of an execution in time")
    return moment.now
