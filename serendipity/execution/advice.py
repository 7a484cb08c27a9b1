"""Advice to robots: what they had best do from a moment on; and who gives it beside a person who replans.

Advice is kept while it is any good, and made better while there is time.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final, Protocol

from search.modes.simulation.companion import Companion, Course
from serendipity.execution.guard import Following, RobotActions
from serendipity.facade.results import named_steps
from serendipity.model import Deadline, PlanStep, Step, Task, Window
from serendipity.model.task.actions import apply

Allows = Callable[[Sequence[int]], bool]
"""Whether actions, those of the person left aside, may be what happens in the epoch that is to come."""


@dataclass(frozen=True, slots=True)
class Advice:
    """A plan from the present moment.

    Attributes:
        plan: what everybody does, its epochs counted from the one that is to come.
        window: where the person is met, as far as the plan says so.
        cost: what it costs the team.
        pays: whether robots do something in it that is worth it.
        proved: whether nothing better is possible.
    """

    plan: tuple[PlanStep, ...]
    window: Window | None
    cost: Fraction
    pays: bool
    proved: bool

    def by_themselves(self, task: Task) -> bool:
        """Whether robots have no part in it."""
        return all(step.agents == (task.agents[task.human],) for step in self.plan)


@dataclass(frozen=True, slots=True)
class DecisionPoint:
    """An epoch that is to come, whichever goal the person has.

    Attributes:
        state: ids of the facts that are true.
        out: ids of actions that nobody can do any more.
        barred: these, and those that wait for what robots have begun to be finished.
        running: ids of what they have begun, and go on with in any case.
        allows: what may happen in it.
    """

    state: frozenset[int]
    out: frozenset[int]
    barred: frozenset[int]
    running: frozenset[int]
    allows: Allows


class Adviser(Protocol):
    """Plans for one goal of the person's."""

    def advise(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Advice | None:
        """The best plan that is found in time; None where there is none.

        Args:
            following: what the person may be following.
            now: where things stand.

        Raises:
            LimitReachedError: the deadline came before there was any.
        """


_RESCUE: Final = 10.0
"""The most seconds for a way out where the person has no plan alone: nothing says how far it may be."""


@dataclass(frozen=True, slots=True)
class _Kept:
    """The rest of a plan after its first epoch.

    Attributes:
        state: ids of the facts that are true then, if all goes as planned.
        barred: what nobody was to do.
        rest: its epochs counted from there.
        pays: whether the plan was worth it.
    """

    state: frozenset[int]
    barred: frozenset[int]
    rest: Course
    pays: bool


class ReactiveAdviser:
    """Plans for one goal of a person who replans (semantics 6).

    A plan that is proved is followed while all goes as planned.  Any other is what the next epoch begins
    with: what is found then has to be better, whatever the person has done meanwhile.

    Args:
        discount: of robots' costs.
        companion: who plans.
        actions: what robots can do.
        pointless: ids of actions that can't pay with this goal.
    """

    def __init__(
        self,
        task: Task,
        discount: Fraction,
        companion: Companion,
        actions: RobotActions,
        pointless: frozenset[int] = frozenset(),
    ) -> None:
        self._pointless = pointless
        self._task = task
        self._discount = discount
        self._companion = companion
        self._actions = actions
        self._kept: _Kept | None = None

    def advise(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Advice | None:
        """See :class:`.advice.Adviser`."""
        course = self._as_planned(following, now, deadline)
        pays = course is not None and self._kept is not None and self._kept.pays
        if course is None:
            course = self._anew(following, now, deadline)
            pays = course is not None and course.pays
        self._kept = None if course is None else self._rest(now, course, pays=pays)
        if course is None:
            return None
        plan = named_steps(self._task, self._discount, course.steps)
        return Advice(plan, None, course.cost, pays, course.proved)

    def _as_planned(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Course | None:
        """The rest of the plan, where nothing has come between and it is known to be the best."""
        kept = self._kept
        if kept is None or not kept.rest.proved or (kept.state, kept.barred) != (now.state, now.barred):
            return None
        if not now.allows([step.action for step in kept.rest.steps if step.epoch == 1]):
            return None
        played = self._companion.played(following.start_of(self._companion.human), kept.rest.steps, deadline)
        skipped = any(epoch.skipped for epoch in played.epochs)
        if skipped or not played.goals_hold or played.cost > kept.rest.cost:
            return None
        alone, theirs = following.alone, self._actions.all
        if alone is not None and played.cost >= alone and theirs.intersection(s.action for s in played.steps):
            return None  # the way out of where there was no plan alone, and now there is one as cheap
        return replace(kept.rest, steps=tuple(played.steps), cost=played.cost)

    def _anew(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Course | None:
        if following.hopeless:
            deadline = deadline.within(_RESCUE)
        return self._companion.course(
            following.start_of(self._companion.human),
            self._rounds(now.barred | self._pointless),
            deadline,
            begins=now.allows,
            known=() if self._kept is None else self._kept.rest.steps,
        )

    def _rounds(self, barred: frozenset[int]) -> Sequence[frozenset[int]]:
        """Each robot by itself, then all of them."""
        robots = [robot for robot in self._task.robots if not self._actions.of([robot]) <= barred]
        if len(robots) < 2:
            return [barred]
        alone = [barred | self._actions.of(r for r in robots if r != robot) for robot in robots]
        return [*alone, barred]

    def _rest(self, now: DecisionPoint, course: Course, *, pays: bool) -> _Kept:
        """The plan as it will be after its first epoch."""
        first = [self._task.actions[step.action] for step in course.steps if step.epoch == 1]
        spent = sum((self._task.team_cost(action, self._discount) for action in first), Fraction(0))
        later = tuple(Step(step.epoch - 1, step.action) for step in course.steps if step.epoch > 1)
        rest = replace(course, steps=later, cost=course.cost - spent)
        return _Kept(apply(now.state, *first), now.barred, rest, pays)
