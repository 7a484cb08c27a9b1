"""The human's actions after the window, with time (semantics 3.1 rule 3, 3.3, 10.1)."""

from collections.abc import Iterator
from functools import cache
from typing import Protocol

from serendipity.model import HumanPlan, Options, Task
from serendipity.testing.oracle.alone_in_time import AloneInTime
from serendipity.testing.oracle.labels import NOTHING, Front, Label, front, plus
from serendipity.testing.oracle.moments import Moment


class SuffixPrices(Protocol):
    """What labels and ends of suffixes depend on."""

    def price(self, i: int) -> Label:
        """Of an action."""

    def waiting(self, epochs: int) -> Label:
        """Of some epochs of waiting."""

    def lasts(self, moment: Moment, epoch: int, last: int) -> bool:
        """Whether all goals hold after epoch ``last`` if everybody is idle until then."""


class SuffixesInTime:
    """The suffixes of a call.

    Args:
        task: the task.
        options: which rule is in force.
        human_plan: ``pi_H``.
        alone: the human alone.
        prices: of actions and waiting.
        last: ``T``.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        human_plan: HumanPlan,
        alone: AloneInTime,
        prices: SuffixPrices,
        last: int,
    ) -> None:
        self.task = task
        self.options = options
        self.plan = human_plan
        self.alone = alone
        self.world = alone.world
        self.prices = prices
        self.last = last
        self.replan = cache(self._replan)
        self.follow = cache(self._follow)
        self._expected = [*self._states()] if options.preservation == "state" else []

    def of(self, moment: Moment, xi1: int, epoch: int) -> Front:
        """Labels of what the human may do from a moment on, ``epoch`` being over.

        What they are at goes on first.
        """
        now: Moment | None = moment
        while now is not None and self.world.busy(now, self.task.human):
            epoch += 1
            now = self.world.alone(now, epoch)
        if now is None or epoch > self.last:
            return ()
        if self.options.preservation == "state":
            return self._preserved(now, xi1, epoch)
        if self.options.suffix == "subplan":
            return self.follow(now, epoch, 0, True)
        worth = self.alone.worth(now._replace(retired=False), epoch)
        if worth is None or epoch + worth[1] > self.last:
            return ()
        label = self.replan(now, epoch, False)
        return () if label is None else (label,)

    def _replan(self, moment: Moment, epoch: int, acts: bool) -> Label | None:
        """The best for the objective of the human's optimal plans; ``acts``: with an action at least."""
        plain = moment._replace(retired=False)
        resting = self.alone.resting(plain, epoch)
        if not acts and resting is not None and resting == self.alone.worth(plain, epoch):
            return NOTHING if self.prices.lasts(moment, epoch, self.last) else None
        if moment.retired:
            return None
        found: list[Label] = []
        for way in self.alone.best(plain, epoch):
            price = self.prices.waiting(1) if way.action is None else self.prices.price(way.action)
            rest = self.replan(way.moment, way.epoch, way.action is None)
            if rest is not None:
                found.append(plus(price, rest))
        return min(found, default=None)

    def _follow(self, moment: Moment, epoch: int, index: int, may_skip: bool) -> Front:
        """Actions of ``pi_H`` from an index on, each at most once; all, unless some may be skipped."""
        labels: list[Label] = []
        if (may_skip or index == len(self.plan)) and self.prices.lasts(moment, epoch, self.last):
            labels.append(NOTHING)
        if not moment.retired:
            indices = range(index, len(self.plan)) if may_skip else range(index, len(self.plan))[:1]
            for k in indices:
                labels += self._done(moment, epoch, k, may_skip)
            labels += self._waited(moment, epoch, index, may_skip)
        return front(labels)

    def _done(self, moment: Moment, epoch: int, k: int, may_skip: bool) -> Iterator[Label]:
        action = self.plan[k]
        ways = (way for way in self.alone.ways(moment, epoch) if way.action == action)
        for way in ways:
            if way.epoch <= self.last:
                for rest in self.follow(way.moment, way.epoch, k + 1, may_skip):
                    yield plus(self.prices.price(action), rest)

    def _waited(self, moment: Moment, epoch: int, index: int, may_skip: bool) -> Iterator[Label]:
        """Waiting, while the script lasts, before an action."""
        for way in self.alone.ways(moment, epoch):
            if way.action is None and way.epoch < self.last:
                for rest in self.follow(way.moment, way.epoch, index, may_skip):
                    if rest[2]:
                        yield plus(self.prices.waiting(1), rest)

    def _preserved(self, moment: Moment, xi1: int, epoch: int) -> Front:
        """Def. 3.1 literally: the state entails that after ``pi_H[1..j]``, then ``pi_H[j+1..]``."""
        begun = sum(start < xi1 for start in self.task.starts_of(self.plan))
        mentioned = set(self.task.goal.positive) | set(self.task.goal.negative)
        for i in self.task.human_actions:
            for part in self.world.parts(i):
                mentioned |= {*part.pre, *part.neg, *part.add, *part.delete}
        labels: list[Label] = []
        for j in range(begun, len(self.plan) + 1):
            if moment.state >= (self._expected[j] & mentioned):
                labels += self.follow(moment, epoch, j, False)
        return front(labels)

    def _states(self) -> Iterator[frozenset[int]]:
        """The states in which ``pi_H`` has ended its first j actions, robots idle."""
        now, epoch = Moment(self.task.init), 0
        yield now.state
        for start, action in zip(self.task.starts_of(self.plan), self.plan, strict=True):
            for following in range(epoch + 1, start + self.task.actions[action].duration):
                onward = self.world.alone(now, following, action if following == start else None)
                assert onward is not None, "pi_H is a plan"
                now, epoch = onward, following
            yield now.state
