"""Brute force for semantics 11: every policy of the robots, by recursion over what they have seen.

Where robots can't tell scenarios apart, these are a group: they share what robots do by themselves,
and so their state.  The recursion is over (epoch, group); what comes of it are vectors with the worth
of each scenario, since ``risk`` decides only at the end which vector is the least.  Robots that commit
themselves see nothing, so each scenario has a worth for each sequence of what they do.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from itertools import chain, product
from typing import NamedTuple, Protocol

from serendipity.model import Condition, GroundAction, HumanPlan, Options, Task, UsageError
from serendipity.testing.oracle.answers import smallest_unit
from serendipity.testing.oracle.epochs import State, action_sets, after, compatible, holds, usable
from serendipity.testing.oracle.suffixes import CanonicalSuffix

Worth = tuple[Fraction, Fraction]
"""Objective and cost; the lower objective is better, then the lower cost."""

Units = tuple[int, int]
"""The same in the call's smallest unit of cost."""

Vector = tuple[Units, ...]
"""One worth for each scenario."""

Vectors = tuple[Vector, ...]


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
    longest = max(len(scenario.plan) for scenario in scenarios)
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
    idle = min(map(worth, _Policies(task, options, scenarios, last, robots=False).vectors()))
    baseline = worth(kept)[1]
    if least[1] < idle[1]:
        return PolicyOptimum(*least, True, baseline, idle, least)
    return PolicyOptimum(baseline, baseline, False, baseline, idle, least)


class _Situation(NamedTuple):
    """Where a scenario is; without ``since`` and ``rest`` the human has followed their plan so far."""

    scenario: int
    state: State
    since: int | None = None
    """The first epoch of the window that they are in."""
    rest: HumanPlan | None = None
    """What is left to do after the window."""


_Group = tuple[_Situation, ...]


class _Way(NamedTuple):
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
        self.suffixes = [
            CanonicalSuffix(replace(task, goal=scenario.goal), options, scenario.plan)
            for scenario in scenarios
        ]
        self.own = [i for i, a in enumerate(task.actions) if robots and task.human not in a.participants]
        human = [a for a in task.actions if task.human in a.participants and (robots or not a.joint)]
        self.parts: list[GroundAction | None] = [None, *human]
        self.front, self.part, self.ways = cache(self._front), cache(self._part), cache(self._ways)
        self.committed = cache(self._committed)

    def vectors(self) -> Iterator[tuple[Worth, ...]]:
        """What policies are worth; those that are no better in any scenario than others may be missing."""
        start = tuple(_Situation(k, self.task.init) for k in range(len(self.scenarios)))
        vectors = self.front(1, start) if self.options.policy == "watching" else self._in_common(start)
        for vector in vectors:
            yield tuple((Fraction(a, self.unit), Fraction(b, self.unit)) for a, b in vector)

    def _in_common(self, start: _Group) -> Iterator[Vector]:
        """What each sequence is worth that robots can commit themselves to."""
        first, *others = (self.committed(1, now) for now in start)
        for sequence, worth in first.items():
            if all(sequence in other for other in others):
                yield (worth, *(other[sequence] for other in others))

    def _committed(self, epoch: int, now: _Situation) -> Mapping[tuple[tuple[int, ...], ...], Units]:
        """The least worth of one scenario from an epoch on, by what robots do by themselves in each epoch."""
        if epoch > self.horizon:
            end = self._end(now)
            return {} if end is None else {(): end}
        found: dict[tuple[tuple[int, ...], ...], Units] = {}
        for robots in self._robots((now,)):
            for way in chain.from_iterable(self.ways(epoch, now, robots).values()):
                for rest, more in self.committed(epoch + 1, way.now).items():
                    worth = (way.worth[0] + more[0], way.worth[1] + more[1])
                    found[robots, *rest] = min(worth, found.get((robots, *rest), worth))
        return found

    def _front(self, epoch: int, group: _Group) -> Vectors:
        """What the rest can be worth to a group, from the beginning of an epoch on."""
        if epoch > self.horizon:
            ends = [self._end(now) for now in group]
            return (tuple(end for end in ends if end is not None),) if None not in ends else ()
        found: set[Vector] = set()
        for robots in self._robots(group):
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

    def _robots(self, group: _Group) -> Iterator[tuple[int, ...]]:
        """What robots may do by themselves, the same in the whole group."""
        if any(now.rest is not None for now in group):
            yield ()
            return
        yield from action_sets(self.task, group[0].state, self.own, strict=self.options.strict)

    def _ways(
        self, epoch: int, now: _Situation, robots: tuple[int, ...]
    ) -> Mapping[str | None, Sequence[_Way]]:
        """Everything that the human may do beside the robots, by what these see of it."""
        found: dict[str | None, list[_Way]] = {}
        for way in self._human(epoch, now, [self.task.actions[i] for i in robots]):
            found.setdefault(way.seen, []).append(way)
        return found

    def _human(self, epoch: int, now: _Situation, robots: Sequence[GroundAction]) -> Iterator[_Way]:
        """Rules 1 to 3 of semantics 3.1."""
        if now.rest is not None:
            yield from self._way(now, robots, self._action(now.rest, 0), rest=now.rest[1:])
            return
        plan, since = self.scenarios[now.scenario].plan, now.since
        if since is None:
            yield from self._way(now, robots, self._action(plan, epoch - 1))
            since = epoch
        most = self.options.max_window or self.horizon
        if since <= len(plan) and epoch - since < most:
            for his in self.parts:
                for way in self._way(now, robots, his, since=since):
                    inside = way._replace(worth=(way.worth[0] + self.weight, way.worth[1]))
                    yield inside
                    yield from self._closed(epoch, inside)

    def _way(
        self,
        now: _Situation,
        robots: Sequence[GroundAction],
        his: GroundAction | None,
        *,
        since: int | None = None,
        rest: HumanPlan | None = None,
    ) -> Iterator[_Way]:
        """The epoch with an action of the human's, if they can do that beside the robots."""
        actions = list(robots)
        if his is not None:
            if not all(compatible(his, action, strict=self.options.strict) for action in robots):
                return
            actions.append(his)
        if all(usable(action, now.state) for action in actions):
            costs = (self.task.team_cost(action, self.options.discount) for action in actions)
            cost = int(sum(costs, Fraction(0)) * self.unit)
            state = after(now.state, actions)
            seen = None if his is None else his.name
            yield _Way(seen, (cost, cost), _Situation(now.scenario, state, since, rest))

    def _closed(self, epoch: int, inside: _Way) -> Iterator[_Way]:
        """The same epoch, as the last one of the window."""
        scenario, state, since, _ = inside.now
        assert since is not None
        rest = self.suffixes[scenario].plan(state, since, self.horizon - epoch)
        if rest is not None:
            yield inside._replace(now=_Situation(scenario, state, None, rest))

    def _end(self, now: _Situation) -> Units | None:
        """What comes on top after ``T``; None where it can't end like this."""
        if now.rest is not None:
            return (0, 0)
        if now.since is not None or not holds(self.scenarios[now.scenario].goal, now.state):
            return None
        return (self.weight, 0)

    def _action(self, plan: HumanPlan, index: int) -> GroundAction | None:
        return self.task.actions[plan[index]] if index < len(plan) else None


def _undominated(vectors: set[Vector]) -> Vectors:
    """Without those that another one is no worse than in any scenario."""

    def beats(a: Vector, b: Vector) -> bool:
        return a != b and all(one <= other for one, other in zip(a, b, strict=True))

    return tuple(v for v in vectors if not any(beats(other, v) for other in vectors))
