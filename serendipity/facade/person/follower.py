"""Somebody who follows a plan of their own, and looks up whenever they are free (semantics 6, 10.6)."""

from collections.abc import Iterable, Sequence
from copy import copy
from random import Random
from typing import Self

from serendipity.facade.person.sight import Sight
from serendipity.facade.person.ways import Entries, Way, Ways, entries_of
from serendipity.model import Deadline, HumanPlan, PlanError, PlanStep, Task
from serendipity.model.task.actions import NOOP, GroundAction
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.execution import actions_named
from serendipity.model.task.passing import at_work, epoch_later
from serendipity.model.task.plans import TimedPlan


class Follower:
    """The rest of what the person means to do, epoch by epoch.

    Args:
        ways: what they could do alone.
        dice: draw which of their optimal plans they follow; None: the canonical one.
        sight: what they see of where they are, and believe of all else; None: they see everything.

    Attributes:
        rest: what they mean to do; None where nobody knows.
        faithful: whether they go on with that as long as it works, though another way be cheaper, and later
            where they are late.
        held: whether they keep it for later: they wait for a way, are at something with others, or have
            tried something in vain.
    """

    def __init__(self, ways: Ways, dice: Random | None = None, sight: Sight | None = None) -> None:
        self.rest: Entries | None = None
        self.faithful = False
        self.held = False
        self.ways = ways
        self.sight = sight
        self._dice = dice

    def copy(self) -> Self:
        """Another one who means to do the same, and believes the same."""
        other = copy(self)
        other.sight = copy(self.sight)
        return other

    def believed(self, now: Task) -> Task:
        """How they take a task to stand; if they are free they have a look."""
        if self.sight is None:
            return now
        if now.human not in at_work(now):
            self.sight.look(now)
        return self.sight.believed

    def knows(self, now: Task) -> bool:
        """Whether they are right about how a task stands, having looked."""
        return self.sight is None or self.sight.is_right(now)

    def expects(self, begun: Iterable[GroundAction]) -> None:
        """An epoch is over, in which they have begun something; all else they take to go on."""
        if self.sight is not None:
            self.sight.passed(begun)

    def failed(self, tried: GroundAction, now: Task) -> None:
        """They have tried something in vain: one who may be wrong learns why, and keeps it in mind."""
        if self.sight is None:
            self.rest = None
            return
        self.sight.learn(tried, now)
        self.held = True

    def look(self, now: Task, deadline: Deadline) -> Way | None:
        """They look up: they keep their plan, or make another that is cheaper, or where theirs does not work.

        Args:
            now: the task as it stands; they are free.

        Returns:
            Their plan; None where they have none, and wait.

        Raises:
            LimitReachedError: the deadline came first.
        """
        self.held = False
        now = self.believed(now)
        best = self.ways.of(now, deadline)
        kept = self.working(now)
        if kept is not None:
            price = self.ways.price(now, kept)
            if self.faithful or best is None or price <= best.cost:
                return Way(entries_of(now, kept), price)
        if best is None:
            self.held = True
            return None
        dice = self._dice
        self.rest = best.plan if dice is None else entries_of(now, self.ways.drawn(now, dice))
        return Way(self.rest, best.cost)

    def choose(self, now: Task, offers: Sequence[PlanStep], deadline: Deadline) -> PlanStep | str | None:
        """What they begin: an offer that pays as much as their own plan, what that says, or None to wait.

        Raises:
            LimitReachedError: the deadline came first.
        """
        if now.human in at_work(now):
            return None
        mine, believed = self.look(now, deadline), self.believed(now)
        for offer in offers:
            if _is_possible(now, offer) and self._accepts(believed, offer, mine, deadline):
                return offer
        return None if mine is None else self.next

    @property
    def next(self) -> str | None:
        """What they mean to begin in the epoch that is to come."""
        return next((name for epoch, name in self.rest or () if epoch == 1 and name != NOOP), None)

    def passed(self, begun: str | None) -> None:
        """An epoch is over, in which they began something alone, or nothing."""
        if self.rest is None or self.held:
            return
        if self.faithful and begun != self.next:
            is_early = begun is not None and [name for _, name in self.rest[:1]] == [begun]
            left = self.rest if begun is None else tuple((max(e - 1, 1), name) for e, name in self.rest[1:])
            self.rest = left if begun is None or is_early else None
        elif begun != self.next:
            self.rest = None
        else:
            self.rest = tuple((epoch - 1, name) for epoch, name in self.rest if epoch > 1)

    def joined(self) -> None:
        """They have begun something with others: what they mean to do, they do after that."""
        self.held = True

    def plan(self, task: Task) -> HumanPlan | None:
        """What they mean to do, by the ids of a task, its epochs counted from now."""
        rest = [(epoch, name) for epoch, name in self.rest or () if name in task.named]
        if not rest:
            return None
        ids = [task.named[name][0] for _, name in rest]
        end = rest[-1][0] + task.actions[ids[-1]].duration - 1
        return TimedPlan(ids, [epoch for epoch, _ in rest], end)

    def working(self, now: Task) -> HumanPlan | None:
        """What they mean to do, if it works."""
        if self.rest is None:
            return None
        try:
            return now.plan_from_names(self.rest)
        except PlanError:
            return None

    def _accepts(self, now: Task, offer: PlanStep, mine: Way | None, deadline: Deadline) -> bool:
        """Whether a joint action is as good as going on alone (semantics 6, step 2)."""
        for action in (now.actions[i] for i in actions_named(now, offer.action, offer.agents)):
            if not action.applicable(now.init):
                continue
            try:
                later = epoch_later(now, [action])
            except BrokenPlanError:
                continue
            if mine is None:
                return True
            left = self.ways.of(later, deadline)
            return left is not None and action.cost + left.cost <= mine.cost
        return False


def _is_possible(now: Task, offer: PlanStep) -> bool:
    return any(now.actions[i].applicable(now.init) for i in actions_named(now, offer.action, offer.agents))
