"""Prospects: the best plan for each goal that the person may have, and the best for all of them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf
from typing import Generic, Protocol, TypeVar

from serendipity.execution.advice import Advice
from serendipity.model import Deadline, PlanStep, Step, Task
from serendipity.model.answers.simulation import Simulation
from serendipity.model.task.execution import steps_named


class Aim(Protocol):
    """The person with one goal, with time or without."""

    @property
    def task(self) -> Task:
        """The task with it."""

    @property
    def alone(self) -> Fraction | None:
        """What they pay without help; None where they have no plan."""

    def played(self, part: Sequence[Step], deadline: Deadline) -> Simulation:
        """What becomes of what robots do."""


_Aim = TypeVar("_Aim", bound=Aim)


@dataclass(frozen=True, slots=True)
class Prospect(Generic[_Aim]):
    """One of the goals that the person may have, and the best plan for it.

    Attributes:
        goal: index of the goal.
        hypothesis: what is so if it is theirs.
        advice: the plan, from the present state; None where there was none in time.
        weight: how probable the goal is.
    """

    goal: int
    hypothesis: _Aim
    advice: Advice | None
    weight: Fraction

    @property
    def plan(self) -> tuple[PlanStep, ...]:
        """What everybody does by that plan, its epochs counted from the one that is to come."""
        return () if self.advice is None else self.advice.plan

    @property
    def pays(self) -> bool:
        """Whether there is a plan in which robots do something that is worth it."""
        return self.advice is not None and self.advice.pays

    @property
    def open(self) -> bool:
        """Whether robots have a part in such a plan that is still to come."""
        return self.advice is not None and self.pays and not self.advice.by_themselves(self.hypothesis.task)

    @property
    def saving(self) -> Fraction:
        """What the plan saves; where the person has no plan alone, as much as it costs."""
        cost = Fraction(0) if self.advice is None else self.advice.cost
        return cost if self.alone is None else self.alone - cost

    @property
    def alone(self) -> Fraction | None:
        """What the person pays without help; None where they have no plan."""
        return self.hypothesis.alone

    @property
    def figures(self) -> tuple[float, float | None]:
        """What the plan costs, and what the person pays without help."""
        return sum(step.cost for step in self.plan), None if self.alone is None else float(self.alone)


def best_for_all(prospects: Sequence[Prospect[_Aim]], deadline: Deadline) -> Prospect[_Aim] | None:
    """The prospect whose robots' part costs least in the mean over all goals; None if none beats waiting.

    Robots' actions are played against the person with each of the goals, by what is known of how they
    react.  Once people with different goals do different things, robots go on as it is best for those who
    do the same: with that plan, with another one, or not at all.
    """
    played = _Played(prospects, deadline)
    best: Prospect[_Aim] | None = None
    least: Fraction | float = sum((p.weight * (p.alone or 0) for p in prospects), Fraction(0))
    for prospect in prospects:
        if prospect.pays and (cost := played.mean(prospect, least)) < least:
            best, least = prospect, cost
    waits = best is not None and played.begins(best) and played.mean(None, least) < least
    return None if waits else best


_Robots = tuple[Step, ...]
"""What robots do."""


class _Played(Generic[_Aim]):
    """Robots' parts of some plans, played against the person with each goal."""

    def __init__(self, prospects: Sequence[Prospect[_Aim]], deadline: Deadline) -> None:
        self._prospects = prospects
        self._deadline = deadline
        task = prospects[0].hypothesis.task
        self._parts = [
            tuple(
                s for s in steps_named(task, p.plan) if task.actions[s.action].participants != (task.human,)
            )
            for p in prospects
        ]
        self._known: dict[tuple[int, _Robots], Simulation] = {}

    def begins(self, chosen: Prospect[_Aim]) -> bool:
        """Whether a prospect's part begins in the epoch that is to come."""
        return any(step.epoch == 1 for step in self._part(chosen))

    def mean(self, chosen: Prospect[_Aim] | None, least: Fraction | float) -> Fraction | float:
        """What it costs to begin with a prospect's part, or with nothing, until people are told apart.

        Anything where that is no less than ``least``.
        """
        part = () if chosen is None else self._part(chosen)
        deeds = [self._deeds(i, part) for i in range(len(self._prospects))]
        told = min((_alike(deeds[0], other) for other in deeds[1:]), default=0) + 1
        groups: dict[tuple[str | None, ...], list[int]] = {}
        for i, done in enumerate(deeds):
            groups.setdefault(done[:told], []).append(i)
        begun = tuple(step for step in part if step.epoch <= told)
        rests = [tuple(step for step in part if step.epoch > told) for part in self._parts]
        late = [tuple(replace(step, epoch=step.epoch + told) for step in part) for part in self._parts]
        ways = [part, begun, *(begun + rest for rest in (*rests, *(late if chosen is None else ())))]
        total: Fraction | float = Fraction(0)
        for group in groups.values():
            total += self._least(group, ways)
            if total >= least:
                break
        return total

    def _part(self, prospect: Prospect[_Aim]) -> _Robots:
        return self._parts[self._prospects.index(prospect)]

    def _least(self, group: Sequence[int], parts: Iterable[_Robots]) -> Fraction | float:
        """The weight of some goals times the cost of the part that is best for all of them."""
        return min(sum((self._cost(i, part) for i in group), Fraction(0)) for part in dict.fromkeys(parts))

    def _cost(self, i: int, part: _Robots) -> Fraction | float:
        played = self._play(i, part)
        return self._prospects[i].weight * played.cost if played.goals_hold else inf

    def _deeds(self, i: int, part: _Robots) -> tuple[str | None, ...]:
        """What the person with a goal does, epoch by epoch."""
        actions = self._prospects[i].hypothesis.task.actions
        his = (
            epoch.own if epoch.accepted is None else epoch.accepted for epoch in self._play(i, part).epochs
        )
        return tuple(None if action is None else actions[action].name for action in his)

    def _play(self, i: int, part: _Robots) -> Simulation:
        found = self._known.get((i, part))
        if found is None:
            found = self._known[i, part] = self._prospects[i].hypothesis.played(part, self._deadline)
            self._deadline.check()
        return found


def _alike(some: Sequence[object], others: Sequence[object]) -> int:
    """How many epochs begin both."""
    return next(
        (i for i, (a, b) in enumerate(zip(some, others, strict=False)) if a != b), min(len(some), len(others))
    )
