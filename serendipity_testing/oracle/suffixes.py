"""The human's actions after the window (semantics 3.1 rule 3, 3.3, 10.1)."""

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Protocol

from serendipity.model import HumanPlan, Options, Task
from serendipity_testing.oracle.alone import Alone
from serendipity_testing.oracle.epochs import State, after, holds, usable
from serendipity_testing.oracle.labels import Front, Label, front, plus
from serendipity_testing.oracle.moments import Moment, OracleWorld
from serendipity_testing.oracle.noticing import Notices


class SuffixPrices(Protocol):
    """What labels and ends of suffixes depend on."""

    def price(self, i: int) -> Label:
        """Of an action."""

    def waiting(self, epochs: int) -> Label:
        """Of some epochs of waiting."""

    def ended(self, moment: Moment, epoch: int, last: int) -> Label | None:
        """What the end costs if everybody is idle until epoch ``last``; None if not all goals hold then."""


class Suffixes:
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
        alone: Alone,
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
        self.of = cache(self._of)
        self._expected = _states(self.world, human_plan) if options.preservation == "state" else []

    def _of(self, moment: Moment, xi1: int, epoch: int) -> Front:
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
            return self.prices.ended(moment, epoch, self.last)
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
        ended = self.prices.ended(moment, epoch, self.last) if may_skip or index == len(self.plan) else None
        if ended is not None:
            labels.append(ended)
        if not moment.retired:
            indices = range(index, len(self.plan)) if may_skip else range(index, len(self.plan))[:1]
            for k in indices:
                labels += self._done(moment, epoch, k, may_skip)
            labels += self._waited(moment, epoch, index, may_skip)
        return front(labels)

    def _done(self, moment: Moment, epoch: int, k: int, may_skip: bool) -> Iterator[Label]:
        way = self.alone.acted(moment, epoch, self.plan[k])
        if way is not None and way.epoch <= self.last:
            for rest in self.follow(way.moment, way.epoch, k + 1, may_skip):
                yield plus(self.prices.price(self.plan[k]), rest)

    def _waited(self, moment: Moment, epoch: int, index: int, may_skip: bool) -> Iterator[Label]:
        """Waiting, while the script lasts, before an action."""
        way = self.alone.waited(moment, epoch)
        if way is not None and way.epoch < self.last:
            for rest in self.follow(way.moment, way.epoch, index, may_skip):
                if rest[2]:
                    yield plus(self.prices.waiting(1), rest)

    def _preserved(self, moment: Moment, xi1: int, epoch: int) -> Front:
        """Def. 3.1 literally: the state entails that after ``pi_H[1..j]``, then ``pi_H[j+1..]``."""
        begun = sum(start < xi1 for start in self.task.starts_of(self.plan))
        labels: list[Label] = []
        for j in range(begun, len(self.plan) + 1):
            if moment.state >= self._expected[j]:
                labels += self.follow(moment, epoch, j, False)
        return front(labels)


def _states(world: OracleWorld, human_plan: HumanPlan) -> list[State]:
    """What has to hold after the first j actions of ``pi_H``: what the human's own domain mentions."""
    task = world.task
    mentioned = set(task.goal.positive) | set(task.goal.negative)
    for i in task.human_actions:
        for part in world.parts(i):
            mentioned |= {*part.pre, *part.neg, *part.add, *part.delete}
    now, epoch = Moment(task.init), 0
    found = [now.state & mentioned]
    for start, action in zip(task.starts_of(human_plan), human_plan, strict=True):
        for following in range(epoch + 1, start + task.actions[action].duration):
            onward = world.alone(now, following, action if following == start else None)
            assert onward is not None, "pi_H is a plan"
            now, epoch = onward, following
        found.append(now.state & mentioned)
    return found


class CanonicalSuffix:
    """The one suffix that the human takes: the cheapest, of those the shortest, of those the first by names.

    In time it is the first of their optimal plans that lasts; what keeps actions of ``pi_H`` knows no time.

    Args:
        task: the task.
        options: which rule is in force.
        human_plan: ``pi_H``.
        last: ``T``.
        notices: what the human notices, where that counts.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        human_plan: HumanPlan,
        last: int,
        notices: Notices | None = None,
    ) -> None:
        self.task, self.options, self.human_plan, self.last = task, options, human_plan, last
        self.alone = Alone(task, strict=options.strict, notices=notices)
        self.expected = _states(self.alone.world, human_plan)
        self.plan = cache(self._plan)

    def _plan(self, moment: Moment, xi1: int, epoch: int) -> tuple[int | None, ...] | None:
        """What they begin in each epoch from a moment on, ``epoch`` being over; None where no window fits."""
        if self.options.preservation == "state":
            found = self._rests(moment.state, xi1)
        elif self.options.suffix == "subplan":
            found = self._parts(moment.state, self.human_plan)
        else:
            return self._optimal(moment, epoch)
        return min((plan for plan in found if epoch + len(plan) <= self.last), key=self._order, default=None)

    def _order(self, plan: HumanPlan) -> tuple[Fraction, int, list[str]]:
        return (self.task.cost_of(plan), len(plan), [self.task.actions[i].name for i in plan])

    def _optimal(self, moment: Moment, epoch: int) -> tuple[int | None, ...] | None:
        """Def. 2.0a: the canonical plan of semantics 1, once they have ended what they are at."""
        world, free = self.alone.world, epoch
        now: Moment | None = moment
        while now is not None and world.busy(now, self.task.human):
            free += 1
            now = world.alone(now, free)
        if now is None or self.alone.worth(now, free) is None:
            return None
        for actions, starts, end in self.alone.plans(now, free):
            if end > self.last:
                break
            begun = dict(zip(starts, actions, strict=True))
            reached: Moment | None = now
            for following in range(free + 1, self.last + 1):
                reached = None if reached is None else world.alone(reached, following, begun.get(following))
            if reached is not None and world.reached(reached):
                return tuple(begun.get(following) for following in range(epoch + 1, end + 1))
        return None

    def _parts(self, state: State, rest: HumanPlan) -> Iterator[HumanPlan]:
        """Def. 2.0: the subsequences of ``pi_H`` that work."""
        if holds(self.task.goal, state):
            yield ()
        for k, i in enumerate(rest):
            if usable(self.task.actions[i], state):
                for plan in self._parts(after(state, [self.task.actions[i]]), rest[k + 1 :]):
                    yield (i, *plan)

    def _rests(self, state: State, xi1: int) -> Iterator[HumanPlan]:
        """Def. 3.1 literally: ``pi_H[j+1..]``, where the state entails ``delta(I, pi_H[1..j])``."""
        for j in range(xi1 - 1, len(self.human_plan) + 1):
            rest = self.human_plan[j:]
            if state >= self.expected[j] and rest in self._parts(state, rest):
                yield rest
