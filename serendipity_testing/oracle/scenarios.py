"""Brute force for semantics 11: every policy of the robots, by recursion over what they have seen.

Where robots can't tell scenarios apart, these are a group: they share what robots begin by themselves,
and so their state, and what is under way in time.  The recursion is over (epoch, group); what comes of it
are vectors with the worth of each scenario, since ``risk`` decides only at the end which vector is the least.
Robots that commit themselves see nothing: all scenarios stay a group, and what robots begin has to be
possible in each.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from itertools import chain, product
from typing import NamedTuple, Protocol

from serendipity.model import Condition, HumanPlan, Options, Task, UsageError
from serendipity.model.task.leftovers import leftovers
from serendipity_testing.oracle.disturbing import Disturbing
from serendipity_testing.oracle.moments import Moment, OracleWorld
from serendipity_testing.oracle.nobody_pays import LastMomentRule, counts_everybody, unpriced
from serendipity_testing.oracle.noticing import Notices
from serendipity_testing.oracle.plans import smallest_unit
from serendipity_testing.oracle.suffixes import CanonicalSuffix

Worth = tuple[Fraction, Fraction]
"""Objective and cost; the lower objective is better, then the lower cost."""

Units = tuple[int, int]
"""The same in the call's smallest unit of cost."""

Vector = tuple[Units, ...]
"""One worth for each scenario."""

Vectors = tuple[Vector, ...]

Rest = tuple[int | None, ...]
"""By epochs what the human begins; None where they wait, or go on."""


class PossibleGoal(Protocol):
    """A scenario."""

    @property
    def goal(self) -> Condition:
        """What the human wants."""

    @property
    def plan(self) -> HumanPlan:
        """How they mean to get it."""

    @property
    def weight(self) -> Fraction:
        """Its probability."""


@dataclass(frozen=True, slots=True)
class PolicyOptimum:
    """The answer of an exact planner.

    Attributes:
        objective: of the answer, which is doing nothing where there is no opportunity.
        cost: of the answer.
        opportunity: whether robots gain anything.
        baseline: cost of the human's plans with idle robots.
        idle: what the human gains alone is in it: the least worth without robots.
        least: the least worth of any policy, helpful or not.
    """

    objective: Fraction
    cost: Fraction
    opportunity: bool
    baseline: Fraction
    idle: Worth
    least: Worth


def best_policy(
    task: Task, options: Options, scenarios: Sequence[PossibleGoal], horizon: int | None = None
) -> PolicyOptimum:
    """The exact answer over scenarios.

    Args:
        task: the task; its own goal plays no part.
        options: of mode ``serendipity``.
        scenarios: at least one; weights add up to 1.
        horizon: ``T``, or None for the length of the longest plan.

    Raises:
        UsageError: the horizon is shorter than a plan.
    """
    longest = max(task.epochs_of(scenario.plan) for scenario in scenarios)
    last = longest if horizon is None else horizon
    if last < longest:
        raise UsageError("horizon: shorter than the human's plan")
    kept = [(task.cost_of(one.plan) + options.window_weight, task.cost_of(one.plan)) for one in scenarios]
    singles = [min(_Policies(task, options, [one], last).vectors())[0] for one in scenarios]

    def worth(vector: Sequence[Worth]) -> Worth:
        """What is minimised, and the cost that goes with it."""
        if options.risk == "worst":
            return max(vector)
        if options.risk == "regret":
            return max((a[0] - b[0], a[1] - b[1]) for a, b in zip(vector, singles, strict=True))
        weighed = [(p.weight * a, p.weight * b) for p, (a, b) in zip(scenarios, vector, strict=True)]
        return sum((a for a, _ in weighed), Fraction(0)), sum((b for _, b in weighed), Fraction(0))

    least = min(map(worth, _Policies(task, options, scenarios, last).vectors()))
    alone = _Policies(task, unpriced(options), scenarios, last, robots=False)
    idle = min(map(worth, alone.vectors()))
    baseline = worth(kept)[1]
    if least[1] < idle[1]:
        return PolicyOptimum(*least, True, baseline, idle, least)
    return PolicyOptimum(baseline, baseline, False, baseline, idle, least)


class _Situation(NamedTuple):
    """Where a scenario is; without ``since`` and ``rest`` the human has followed their plan so far."""

    scenario: int
    moment: Moment
    since: int | None = None
    """The first epoch of the window that they are in."""
    rest: Rest | None = None
    """What they begin after the window, by epochs."""
    paid: Fraction = Fraction(0)
    """What the human has paid, where that is limited."""
    disturbed: int = 0
    """How much they have been disturbed, likewise."""


_Group = tuple[_Situation, ...]


class _Outcome(NamedTuple):
    """What may come of an epoch in a scenario."""

    seen: str | None
    """Name of the human's action; None where they wait."""
    worth: Units
    now: _Situation


class _Policies:
    """All policies of a call; those without any robot if so asked."""

    def __init__(
        self,
        task: Task,
        options: Options,
        scenarios: Sequence[PossibleGoal],
        horizon: int,
        *,
        robots: bool = True,
    ) -> None:
        self.task, self.options, self.horizon = task, options, horizon
        self.scenarios = scenarios
        self.unit = smallest_unit(task, options)
        self.weight = int(options.window_weight * self.unit)
        self.world = OracleWorld(task, strict=options.strict)
        self.starts = [dict(zip(task.starts_of(one.plan), one.plan, strict=True)) for one in scenarios]
        tasks = [replace(task, goal=one.goal) for one in scenarios]
        notices = [
            Notices(own, one.plan) if options.noticed else None
            for own, one in zip(tasks, scenarios, strict=True)
        ]
        self.worlds = [
            OracleWorld(own, strict=options.strict, notices=seen)
            for own, seen in zip(tasks, notices, strict=True)
        ]
        self.suffixes = [
            CanonicalSuffix(own, options, one.plan, horizon, seen)
            for own, one, seen in zip(tasks, scenarios, notices, strict=True)
        ]
        self.disturbing = Disturbing(self.world, options)
        self.own = [i for i, a in enumerate(task.actions) if robots and task.human not in a.participants]
        human = [i for i, a in enumerate(task.actions) if task.human in a.participants]
        self.parts: list[int | None] = [None, *(i for i in human if robots or not task.actions[i].joint)]
        self.rules: list[LastMomentRule] = []
        self.limited = counts_everybody(task, options)
        if self.limited or leftovers(options) is not None:
            self.rules = [LastMomentRule(self.world, options, one.plan, horizon) for one in scenarios]
        self.front, self.part, self.ways = cache(self._front), cache(self._part), cache(self._ways)

    def vectors(self) -> Iterator[tuple[Worth, ...]]:
        """What policies are worth; those that are no better in any scenario than others may be missing."""
        start = tuple(_Situation(k, Moment(self.task.init)) for k in range(len(self.scenarios)))
        for vector in self.front(1, start):
            yield tuple((Fraction(a, self.unit), Fraction(b, self.unit)) for a, b in vector)

    def _front(self, epoch: int, group: _Group) -> Vectors:
        """What the rest can be worth to a group, from the beginning of an epoch on."""
        if epoch > self.horizon:
            ends = [self._end(now) for now in group]
            return (tuple(end for end in ends if end is not None),) if None not in ends else ()
        found: set[Vector] = set()
        for robots in self._robots(epoch, group):
            for told in product(*(self.ways(epoch, now, robots) for now in group)):
                parts: dict[str | None, list[int]] = {}
                for k, seen in enumerate(told):
                    parts.setdefault(seen, []).append(k)
                fronts = [
                    self.part(epoch, tuple(group[k] for k in part), robots, seen)
                    for seen, part in parts.items()
                ]
                order = [k for part in parts.values() for k in part]
                for chosen in product(*fronts):
                    worths = zip(order, chain.from_iterable(chosen), strict=True)
                    found.add(tuple(worth for _, worth in sorted(worths)))
        return _undominated(found)

    def _part(self, epoch: int, group: _Group, robots: tuple[int, ...], seen: str | None) -> Vectors:
        """The same, once it is settled what robots do by themselves and what they see."""
        found: set[Vector] = set()
        for ways in product(*(self.ways(epoch, now, robots)[seen] for now in group)):
            for rest in self.front(epoch + 1, tuple(way.now for way in ways)):
                worths = zip((way.worth for way in ways), rest, strict=True)
                found.add(tuple((a + more, b + spent) for (a, b), (more, spent) in worths))
        return _undominated(found)

    def _robots(self, epoch: int, group: _Group) -> Iterator[tuple[int, ...]]:
        """What robots may begin by themselves, the same in the whole group."""
        if any(now.rest is not None for now in group):
            yield ()
            return
        yield from (chosen for chosen, _ in self.world.sets(group[0].moment, epoch, self.own))

    def _ways(
        self, epoch: int, now: _Situation, robots: tuple[int, ...]
    ) -> Mapping[str | None, Sequence[_Outcome]]:
        """Everything that the human may do beside the robots, by what these see of it."""
        found: dict[str | None, list[_Outcome]] = {}
        for way in self._human(epoch, now, robots):
            seen = way.seen if self.options.policy == "watching" else None
            found.setdefault(seen, []).append(way)
        return found

    def _human(self, epoch: int, now: _Situation, robots: tuple[int, ...]) -> Iterator[_Outcome]:
        """Rules 1 to 3 of semantics 3.1."""
        if now.rest is not None:
            his = now.rest[0] if now.rest else None
            yield from self._way(epoch, now, robots, his, rest=now.rest[1:])
            return
        since = now.since
        if since is None:
            yield from self._way(epoch, now, robots, self.starts[now.scenario].get(epoch))
            since = epoch
        most = self.options.max_window or self.horizon
        if since <= self.task.epochs_of(self.scenarios[now.scenario].plan) and epoch - since < most:
            for his in self.parts:
                for way in self._way(epoch, now, robots, his, since=since):
                    inside = way._replace(worth=(way.worth[0] + self.weight, way.worth[1]))
                    yield inside
                    yield from self._closed(epoch, inside)

    def _way(
        self,
        epoch: int,
        now: _Situation,
        robots: tuple[int, ...],
        his: int | None,
        *,
        since: int | None = None,
        rest: Rest | None = None,
    ) -> Iterator[_Outcome]:
        """The epoch in which the human begins an action, or none, if they can do that beside the robots."""
        begun = robots if his is None else (*robots, his)
        moment, most = self.worlds[now.scenario].after(now.moment, epoch, begun), self.options.max_disturbance
        disturbed = 0 if most is None else now.disturbed + self.disturbing.by(now.moment, begun)
        if moment is not None and (most is None or disturbed <= self.disturbing.scale * most):
            costs = (self.task.team_cost(self.task.actions[i], self.options.discount) for i in begun)
            cost = int(sum(costs, Fraction(0)) * self.unit)
            seen = None if his is None else self.task.actions[his].name
            paid = now.paid
            if self.limited and his is not None:
                paid += self.task.actions[his].cost
                if paid > self.task.cost_of(self.scenarios[now.scenario].plan):
                    return
            after = _Situation(now.scenario, moment, since, rest, paid, disturbed)
            yield _Outcome(seen, (cost, cost), after)

    def _closed(self, epoch: int, inside: _Outcome) -> Iterator[_Outcome]:
        """The same epoch, as the last one of the window, by when robots have ended what they began."""
        scenario, moment, since, *_ = inside.now
        assert since is not None
        rest = None if self.world.others_busy(moment) else self.suffixes[scenario].plan(moment, since, epoch)
        if rest is not None:
            yield inside._replace(now=inside.now._replace(since=None, rest=rest))

    def _end(self, now: _Situation) -> Units | None:
        """What comes on top after ``T``; None where it can't end like this."""
        price = 0
        if self.rules:
            rule = self.rules[now.scenario]
            if not rule.keeps(now.moment):
                return None
            price = int(rule.price(now.moment) * self.unit)
        if now.rest is not None:
            return (price, price)
        ends = self.world.plan_is_over(now.moment) and now.since is None
        reached = ends and self.worlds[now.scenario].reached(now.moment)
        return (self.weight + price, price) if reached else None


def _undominated(vectors: set[Vector]) -> Vectors:
    """Without those that another one is no worse than in any scenario."""

    def beats(a: Vector, b: Vector) -> bool:
        return a != b and all(one <= other for one, other in zip(a, b, strict=True))

    return tuple(v for v in vectors if not any(beats(other, v) for other in vectors))
