"""What robots must leave alone: the plan that the person is following, and what any other would cost.

Nobody knows which plan a person is following.  Robots take it to be one that was the canonical choice
at some epoch and that they have kept to since.  Nothing that such a plan asks for may be spoilt,
neither what it needs now nor what it will need (the preconditions of its steps, and the goal): it works
after every epoch.  Somebody may be following another plan that is just as cheap.  So whatever they do
next that begins a cheapest plan, the rest must not get dearer by what robots do meanwhile.  Hence a person
who replans when that is cheaper, or has to, never pays more than they would have alone.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from search import PreparedTask
from search.context import SearchContext
from search.packed.cost_vector import INFINITE_KEY
from search.planner import canonical_human_plan
from serendipity.model.errors import PlanError
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import apply, conflicting
from serendipity.model.task.task import HumanPlan, Task


@dataclass(frozen=True, slots=True)
class Needed:
    """What the plans that a person may be following ask for.

    Attributes:
        true: ids of facts that must not become false.
        false: ids of facts that must not become true.
    """

    true: frozenset[int] = frozenset()
    false: frozenset[int] = frozenset()

    def __or__(self, other: "Needed") -> "Needed":
        return Needed(self.true | other.true, self.false | other.false)


class Following:
    """The plans that the person may be following towards one goal.

    Args:
        prepared: the task with that goal.
        strict: whether interference is strict.

    Attributes:
        plans: their steps that are left: those that were predicted, the oldest first.
        prepared: the task with that goal, in the state that was looked at last.
    """

    def __init__(self, prepared: PreparedTask, *, strict: bool) -> None:
        self.plans: list[HumanPlan] = []
        self.prepared = prepared
        self._strict = strict
        his = (prepared.task.actions[i] for i in prepared.task.human_actions)
        facts = {f for a in his for f in (*a.pre, *a.neg, *a.add, *a.delete)}
        self._concern = facts.union(prepared.task.goal.positive, prepared.task.goal.negative)

    @property
    def task(self) -> Task:
        """The task with that goal, in the state that was looked at last."""
        return self.prepared.task

    @property
    def hopeless(self) -> bool:
        """Whether they have no plan alone."""
        return not self.plans

    def look(self, state: frozenset[int], deadline: Deadline) -> Needed:
        """What is to be left alone in a state.

        Raises:
            LimitReachedError: the deadline came first.
        """
        self.prepared = self.prepared.at(state, deadline)
        self.plans = [kept for plan in self.plans if (kept := self._working(plan)) is not None]
        canonical = canonical_human_plan(self.prepared, deadline)
        if canonical is not None and canonical not in self.plans:
            self.plans.append(canonical)
        return self._needed()

    def promise(self) -> HumanPlan:
        """The plan that they go on with if nothing better turns up: the oldest one as cheap as any."""
        costs = [self.task.cost_of(plan) for plan in self.plans]
        return self.plans[costs.index(min(costs))]

    def acted(self, action: int | None) -> None:
        """Say what the person did by themselves: plans that begin otherwise are not theirs."""
        if action is not None:
            name = self.task.actions[action].name
            begun = (plan for plan in self.plans if plan and self.task.actions[plan[0]].name == name)
            self.plans = list(dict.fromkeys(plan[1:] for plan in begun))

    def spoilt(self, robots: Sequence[int], offers: Sequence[int], deadline: Deadline) -> bool:
        """Whether what robots do in an epoch could make it dearer for the person, whichever way they go.

        Args:
            robots: ids of what robots do by themselves.
            offers: ids of joint actions that the person may take part in.
            deadline: polled.

        Raises:
            LimitReachedError: the deadline came first.
        """
        actions = [self.task.actions[i] for i in robots]
        if all(self._concern.isdisjoint((*a.add, *a.delete)) for a in actions):
            return False
        state, alone = self.task.init, _Alone(self.prepared, deadline)
        least = alone.cost(state)
        for i in (*self.task.human_actions, *offers):
            deadline.tick()
            step = self.task.actions[i]
            if not step.applicable(state):
                continue
            rest = alone.cost(apply(state, step))
            if rest is None or (i not in offers and least != alone.price(i) + rest):
                continue  # not the way to go
            if any(conflicting(step, action, strict=self._strict) for action in actions):
                return True
            then = alone.cost(apply(state, step, *actions))
            if then is None or then > rest:
                return True
        return False

    def _needed(self) -> Needed:
        true, false = set[int](), set[int]()
        for plan in self.plans:
            true.update(self.task.goal.positive)
            false.update(self.task.goal.negative)
            for i in plan:
                true.update(self.task.actions[i].pre)
                false.update(self.task.actions[i].neg)
        return Needed(frozenset(true), frozenset(false))

    def _working(self, plan: HumanPlan) -> HumanPlan | None:
        try:
            return self.task.variants_of(plan)
        except PlanError:
            return None


class _Alone:
    """What the person pays alone, scaled to integers.

    Args:
        prepared: the task.
        deadline: polled.
    """

    def __init__(self, prepared: PreparedTask, deadline: Deadline) -> None:
        self._context = SearchContext(prepared, Options(), deadline)

    def cost(self, state: Iterable[int]) -> int | None:
        """The least cost from a state; None where there is no plan."""
        key = self._context.alone.key(self._context.packed.pack(state))
        return None if key >= INFINITE_KEY else self._context.keys.scaled_cost(key)

    def price(self, action: int) -> int:
        """What one of their actions costs."""
        cost = self._context.task.actions[action].cost * self._context.keys.scale
        return cost.numerator


class Hands:
    """What robots can do by themselves, by what it would spoil.

    Args:
        task: the task.

    Attributes:
        all: ids of everything that robots take part in.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self.all = self.of(task.robots)
        self._adding: dict[int, list[int]] = {}
        self._deleting: dict[int, list[int]] = {}
        for i, action in enumerate(task.actions):
            if task.human in action.participants:
                continue
            for fact in action.add:
                self._adding.setdefault(fact, []).append(i)
            for fact in action.delete:
                self._deleting.setdefault(fact, []).append(i)

    def off(self, needed: Needed) -> frozenset[int]:
        """Ids of robots' actions that would spoil something needed."""
        spoiling = {i for fact in needed.true for i in self._deleting.get(fact, ())}
        spoiling.update(i for fact in needed.false for i in self._adding.get(fact, ()))
        return frozenset(spoiling)

    def of(self, robots: Sequence[int]) -> frozenset[int]:
        """Ids of everything that some robots take part in."""
        away = set(robots)
        if not away:
            return frozenset()
        return frozenset(i for i, a in enumerate(self._task.actions) if away.intersection(a.participants))
