"""The human alone, also beside a script: their optimal plans from any moment (semantics 1, 10.3)."""

import heapq
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import NamedTuple

from serendipity.model import Condition, HumanPlan, Script, Task, TimedPlan, UsageError
from serendipity_testing.oracle.moments import Moment, OracleWorld
from serendipity_testing.oracle.noticing import Notices

Worth = tuple[Fraction, int, int]
"""Cost, number of epochs, number of actions."""


class OwnStep(NamedTuple):
    """What the human may do next; ``action`` is None where they wait for an epoch."""

    action: int | None
    price: Worth
    moment: Moment
    epoch: int


class Alone:
    """Optimal costs of the human alone, for all moments that were asked for.

    Epochs are those that are over; moments are ones in which the human is free, or the first ones. Robots may
    be at something.

    Args:
        task: the task.
        waiting_cost: of an epoch of waiting before an action.
        strict: whether interference is strict.
        notices: what they notice, where that counts.
    """

    def __init__(
        self,
        task: Task,
        waiting_cost: Fraction = Fraction(0),
        *,
        strict: bool = False,
        notices: Notices | None = None,
    ) -> None:
        self.task = task
        self.world = OracleWorld(task, strict=strict, notices=notices)
        self.waiting_cost = waiting_cost
        self.worth, self.acting = cache(self._worth), cache(self._least)
        self._settled: dict[Moment, Worth | None] = {}

    def _worth(self, moment: Moment, epoch: int = 0) -> Worth | None:
        """The least (cost, epochs, actions) of a plan of theirs; None if there is none."""
        known = [self.acting(moment, epoch), self.resting(moment, epoch)]
        return min((worth for worth in known if worth is not None), default=None)

    def resting(self, moment: Moment, epoch: int) -> Worth | None:
        """The same without an action: until the goal holds by itself."""
        passed = 0
        now: Moment | None = moment
        while now is not None:
            if self.is_over(now, epoch + passed):
                return (Fraction(0), passed, 0)
            if self._is_calm(now, epoch + passed):
                return None
            passed += 1
            now = self.world.alone(now, epoch + passed)
        return None

    def _least(self, moment: Moment, epoch: int) -> Worth | None:
        """The same with an action at least; None where the goal holds: they have nothing to do."""
        if self.is_over(moment, epoch):
            return None
        if epoch >= self.world.settled:
            if moment not in self._settled:
                self._solve(moment)
            return self._settled[moment]
        found = [_plus(way.price, self._rest(way)) for way in self.ways(moment, epoch)]
        return min((worth for worth in found if worth is not None), default=None)

    def best(self, moment: Moment, epoch: int = 0) -> list[OwnStep]:
        """The ways that begin a plan of the worth of ``acting``, those that act in front."""
        worth = self.acting(moment, epoch)
        if worth is None:
            return []
        return [way for way in self.ways(moment, epoch) if _plus(way.price, self._rest(way)) == worth]

    def is_over(self, moment: Moment, epoch: int) -> bool:
        """Whether the human has what they want, and is at nothing."""
        return self.world.reached(moment) and not self.world.at_work(moment, epoch + 1)

    def _is_calm(self, moment: Moment, epoch: int) -> bool:
        """Whether nothing happens from a moment on unless the human does it."""
        return epoch >= self.world.settled and not moment.going

    def ways(self, moment: Moment, epoch: int = 0) -> Iterator[OwnStep]:
        """Their own actions that can be done, in ascending order; then waiting, while something happens."""
        ways = [*(self.acted(moment, epoch, i) for i in self.task.human_actions), self.waited(moment, epoch)]
        yield from (way for way in ways if way is not None)

    def acted(self, moment: Moment, epoch: int, action: int) -> OwnStep | None:
        """An action of theirs, if it can be done."""
        done = self.task.actions[action]
        begun = self.world.alone(moment, epoch + 1, action)
        end = None if begun is None else self.world.idled(begun, epoch + 1, epoch + done.duration)
        if end is None:
            return None
        return OwnStep(action, (done.cost, done.duration, 1), end, epoch + done.duration)

    def waited(self, moment: Moment, epoch: int) -> OwnStep | None:
        """An epoch of waiting, if something happens meanwhile."""
        later = None if self._is_calm(moment, epoch) else self.world.alone(moment, epoch + 1)
        paid = Fraction(0) if self.world.at_work(moment, epoch + 1) else self.waiting_cost
        return None if later is None else OwnStep(None, (paid, 1, 0), later, epoch + 1)

    def plans(self, moment: Moment, epoch: int) -> Iterator[tuple[tuple[int, ...], tuple[int, ...], int]]:
        """All plans of the worth of a moment, the canonical one first: actions, when they begin, the end.

        There may be several of the same names: first the one that acts as early as it can.
        """
        seen: set[object] = set()
        stack: list[tuple[Moment, int, tuple[int, ...], tuple[int, ...], bool]] = [
            (moment, epoch, (), (), False)
        ]
        while stack:
            now, over, plan, starts, acts = stack.pop()
            names = tuple(self.task.actions[i].name for i in plan)
            if (now, over, names, acts) in seen:
                continue
            seen.add((now, over, names, acts))
            resting = self.resting(now, over)
            if not acts and resting is not None and resting == self.worth(now, over):
                yield plan, starts, over + resting[1]
                continue
            for way in reversed(self.best(now, over)):
                if way.action is None:
                    stack.append((way.moment, way.epoch, plan, starts, True))
                else:
                    stack.append((way.moment, way.epoch, (*plan, way.action), (*starts, over + 1), False))

    def _rest(self, way: OwnStep) -> Worth | None:
        """After waiting there has to be an action: else it was the end of the plan."""
        return (self.acting if way.action is None else self.worth)(way.moment, way.epoch)

    def _solve(self, start: Moment) -> None:
        """Explore everything the human can reach, then one Dijkstra backward from the goal states."""
        late = self.world.settled
        seen, stack = {start}, [start]
        edges: dict[Moment, list[tuple[Moment, Worth]]] = {}
        while stack:
            now = stack.pop()
            for way in self.ways(now, late):
                edges.setdefault(way.moment, []).append((now, way.price))
                if way.moment not in seen:
                    seen.add(way.moment)
                    stack.append(way.moment)
        final: dict[Moment, Worth] = {}
        goals = [moment for moment in seen if self.world.reached(moment)]
        queue: list[tuple[Worth, int, Moment]] = [((Fraction(0), 0, 0), n, m) for n, m in enumerate(goals)]
        ticket = len(queue)
        while queue:
            worth, _, now = heapq.heappop(queue)
            if now in final:
                continue
            final[now] = worth
            for before, price in edges.get(now, ()):
                ticket += 1
                heapq.heappush(queue, (_sum(price, worth), ticket, before))
        for now in seen:
            self._settled[now] = final.get(now)


def _sum(a: Worth, b: Worth) -> Worth:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def _plus(a: Worth, b: Worth | None) -> Worth | None:
    return None if b is None else _sum(a, b)


def human_plans(
    task: Task, waiting_cost: Fraction = Fraction(0), head_start: int = 0, *, strict: bool = False
) -> Iterator[HumanPlan]:
    """All optimal plans of the human alone that differ in names; the canonical one first.

    Of those of the same names, the one that acts as early as it can.

    Args:
        task: the task.
        waiting_cost: of an epoch of waiting before an action.
        head_start: epochs of waiting before the plan.
        strict: whether interference is strict.
    """
    alone = Alone(task, waiting_cost, strict=strict)
    now = alone.world.idled(Moment(task.init), 0, head_start)
    if now is None or alone.worth(now, head_start) is None:
        return
    resting = alone.resting(now, head_start) if _waited(alone, head_start) else None
    if resting is not None:  # which costs nothing, and whatever is begun costs the waiting before it
        yield as_human_plan(task, (), (), head_start + resting[1])
        return
    known: set[tuple[str, ...]] = set()
    for actions, starts, end in alone.plans(now, head_start):
        names = tuple(task.actions[i].name for i in actions)
        if names not in known:
            known.add(names)
            yield as_human_plan(task, actions, starts, end)


def _waited(alone: Alone, head_start: int) -> bool:
    """Whether the human waits in a head start, and that costs something."""
    now: Moment | None = Moment(alone.task.init)
    for epoch in range(1, head_start + 1) if alone.waiting_cost else ():
        if now is not None and not alone.world.at_work(now, epoch):
            return True
        now = None if now is None else alone.world.alone(now, epoch)
    return False


def optimal_human_plan(task: Task) -> HumanPlan | None:
    """The canonical optimal plan of the human alone, or None."""
    return next(human_plans(task), None)


def with_predicted(task: Task, goals: Mapping[str, Condition]) -> Task:
    """The task with some people as bystanders, each on their own optimal plan beside the script so far.

    Args:
        task: the task.
        goals: what each of them wants, in the order in which they are predicted.

    Raises:
        UsageError: one of them has no plan alone.
    """
    for person, goal in goals.items():
        theirs = replace(task.with_human(person), goal=goal, robot_goal=Condition())
        plan = optimal_human_plan(theirs)
        if plan is None:
            raise UsageError(f"script: {person} has no plan alone")
        names = (theirs.actions[i].name for i in plan)
        entries = tuple(zip(theirs.starts_of(plan), names, strict=True))
        known = {**dict(task.own_goals), theirs.human: goal}
        task = replace(task, own_goals=tuple(sorted(known.items())), known_variables=task.variables)
        task = task.with_script(Script(people={person: entries}))
    return task


def as_human_plan(task: Task, actions: tuple[int, ...], starts: tuple[int, ...], length: int) -> HumanPlan:
    """A plan as tasks have it: a plain tuple where the human waits nowhere."""
    free, gaps = 1, False
    for i, start in zip(actions, starts, strict=True):
        gaps = gaps or start != free
        free = start + task.actions[i].duration
    return TimedPlan(actions, starts, length) if gaps or length != free - 1 else actions
