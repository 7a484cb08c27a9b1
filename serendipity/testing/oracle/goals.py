"""Brute force for semantics 8: every robots' plan, beside it every timeline of every goal."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Protocol

from serendipity.model import Condition, GroundAction, HumanPlan, Options, Task
from serendipity.testing.oracle import Alone
from serendipity.testing.oracle.epochs import State, after, compatible, holds, usable

Worth = tuple[Fraction, Fraction]
"""Objective and cost."""

Sets = tuple[tuple[GroundAction, ...], ...]
"""Robots' action sets, one an epoch."""


class PossibleGoal(Protocol):
    """A goal that the human may have."""

    @property
    def goal(self) -> Condition:
        """The goal."""

    @property
    def plan(self) -> HumanPlan:
        """Their plan, if that is it."""

    @property
    def weight(self) -> Fraction:
        """Its probability."""


def robots_sets(task: Task, *, strict: bool) -> list[tuple[GroundAction, ...]]:
    """Every set of robots' actions, without the human, that can share an epoch in some state."""
    own = [action for action in task.actions if task.human not in action.participants]
    sets: list[tuple[GroundAction, ...]] = [()]
    for action in own:
        more = [s for s in sets if all(compatible(action, other, strict=strict) for other in s)]
        sets += [(*s, action) for s in more]
    return sets


def best_expected(task: Task, options: Options, candidates: Sequence[PossibleGoal], horizon: int) -> Worth:
    """Least (objective, cost) over all robots' plans, the human's deviations without robots included."""
    found = []
    for robots in product(robots_sets(task, strict=options.strict), repeat=horizon):
        worths = [_Timeline(task, options, candidate, robots).best() for candidate in candidates]
        if all(worth is not None for worth in worths):
            found.append(
                tuple(
                    sum((c.weight * w[k] for c, w in zip(candidates, worths, strict=True) if w), Fraction(0))
                    for k in range(2)
                )
            )
    objective, cost = min(found)
    return objective, cost


class _Timeline:
    """Every way in which the epochs can go beside one robots' plan, if the candidate is the human's goal."""

    def __init__(self, task: Task, options: Options, candidate: PossibleGoal, robots: Sets) -> None:
        self.task, self.options, self.robots = task, options, robots
        self.goal = candidate.goal
        self.alone = Alone(replace(task, goal=candidate.goal))
        self.plan = [task.actions[i] for i in candidate.plan]
        self.parts = [None, *(a for a in task.actions if task.human in a.participants)]

    def best(self) -> Worth | None:
        """Least (objective, cost)."""
        return self.follow(self.task.init, 0)

    def together(self, state: State, epoch: int, his: GroundAction | None) -> tuple[Fraction, State] | None:
        theirs = self.robots[epoch]
        actions = [*theirs, *([] if his is None else [his])]
        if not all(usable(action, state) for action in actions):
            return None
        if his and not all(compatible(his, r, strict=self.options.strict) for r in theirs):
            return None
        costs = (self.task.team_cost(action, self.options.discount) for action in actions)
        return sum(costs, Fraction(0)), after(state, actions)

    def follow(self, state: State, epoch: int) -> Worth | None:
        """Rule 1 up to ``epoch``; the window opens now, later or never."""
        if epoch == len(self.robots):
            return (self.options.window_weight, Fraction(0)) if holds(self.goal, state) else None
        his = self.plan[epoch] if epoch < len(self.plan) else None
        found = [self.inside(state, epoch)] if his else []
        step = self.together(state, epoch, his)
        if step is not None:
            found.append(_plus(self.follow(step[1], epoch + 1), step[0]))
        return min((worth for worth in found if worth), default=None)

    def inside(self, state: State, epoch: int) -> Worth | None:
        """The window lasts over the epoch; afterwards it ends or goes on."""
        if epoch == len(self.robots):
            return None
        found = []
        for his in self.parts:
            step = self.together(state, epoch, his)
            if step is not None:
                found += [
                    self.ending(step[1], epoch + 1, step[0]),
                    _plus(self.inside(step[1], epoch + 1), step[0]),
                ]
        worths = [(worth[0] + self.options.window_weight, worth[1]) for worth in found if worth]
        return min(worths, default=None)

    def ending(self, state: State, epoch: int, spent: Fraction) -> Worth | None:
        """Rule 3."""
        rest = self.alone.worth(state)
        if any(self.robots[epoch:]) or rest is None or rest[1] > len(self.robots) - epoch:
            return None
        return rest[0] + spent, rest[0] + spent


def _plus(worth: Worth | None, cost: Fraction) -> Worth | None:
    return None if worth is None else (worth[0] + cost, worth[1] + cost)
