"""Advice beside a person who replans: kept while it is any good, made better while there is time."""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from search.modes.simulation.companion import Companion
from serendipity.execution.advice import Advice, Question
from serendipity.execution.guard import Hands
from serendipity.facade.results import named_steps
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import apply
from serendipity.model.task.plans import Step
from serendipity.model.task.task import Task

_RESCUE: Final = 10.0
"""The most seconds for a way out where the person has no plan alone: nothing says how far it may be."""


@dataclass(frozen=True, slots=True)
class _Kept:
    """What is left of a plan after its first epoch.

    Attributes:
        state: ids of the facts that are true then, if all goes as planned.
        barred: what nobody was to do.
        steps: its epochs counted from there.
        cost: what they cost the team.
        pays: whether the plan was worth it.
        proved: whether nothing was better.
    """

    state: frozenset[int]
    barred: frozenset[int]
    steps: tuple[Step, ...]
    cost: Fraction
    pays: bool
    proved: bool


class ReactiveAdviser:
    """Plans for one goal of a person who replans (semantics 6).

    A plan that is proved is followed while all goes as planned.  Any other is what the next epoch begins
    with: what is found then has to be better, whatever the person has done meanwhile.

    Args:
        task: the task with that goal.
        discount: of robots' costs.
        companion: who plans.
        hands: what robots can do.
        pointless: ids of actions that can't pay with this goal.
    """

    def __init__(
        self,
        task: Task,
        discount: Fraction,
        companion: Companion,
        hands: Hands,
        pointless: frozenset[int] = frozenset(),
    ) -> None:
        self._pointless = pointless
        self._task = task
        self._discount = discount
        self._companion = companion
        self._hands = hands
        self._kept: _Kept | None = None

    def advise(self, question: Question, deadline: Deadline) -> Advice | None:
        """See :class:`serendipity.execution.advice.Adviser`."""
        advice = self._as_planned(question, deadline)
        return advice if advice is not None else self._anew(question, deadline)

    def again(self) -> "ReactiveAdviser":
        """See :class:`serendipity.execution.advice.Adviser`."""
        return copy(self)

    def _as_planned(self, question: Question, deadline: Deadline) -> Advice | None:
        kept = self._kept
        if kept is None or not kept.proved or (kept.state, kept.barred) != (question.state, question.barred):
            return None
        if not question.allows([step.action for step in kept.steps if step.epoch == 1]):
            return None
        played = self._companion.played(question.following.start, kept.steps, deadline)
        skipped = any(epoch.skipped for epoch in played.epochs)
        if skipped or not played.goals_hold or played.cost > kept.cost:
            return None
        alone = question.following.alone
        if (
            alone is not None
            and played.cost >= alone
            and self._hands.all.intersection(step.action for step in played.steps)
        ):
            return None  # the way out of where there was no plan alone, and now there is one as cheap
        return self._told(question, played.steps, played.cost, pays=kept.pays, proved=True)

    def _anew(self, question: Question, deadline: Deadline) -> Advice | None:
        known = () if self._kept is None else self._kept.steps
        if question.following.hopeless:
            deadline = deadline.within(_RESCUE)
        course = self._companion.course(
            question.following.start,
            self._rounds(question.barred | self._pointless),
            deadline,
            begins=question.allows,
            known=known,
        )
        if course is None:
            self._kept = None
            return None
        return self._told(question, course.steps, course.cost, pays=course.pays, proved=course.proved)

    def _rounds(self, barred: frozenset[int]) -> Sequence[frozenset[int]]:
        """Each robot by itself, then all of them."""
        robots = [robot for robot in self._task.robots if not self._hands.of([robot]) <= barred]
        if len(robots) < 2:
            return [barred]
        alone = [barred | self._hands.of([r for r in robots if r != robot]) for robot in robots]
        return [*alone, barred]

    def _told(
        self, question: Question, steps: Sequence[Step], cost: Fraction, *, pays: bool, proved: bool
    ) -> Advice:
        actions = self._task.actions
        now = [actions[step.action] for step in steps if step.epoch == 1]
        spent = sum((self._task.team_cost(action, self._discount) for action in now), Fraction(0))
        self._kept = _Kept(
            apply(question.state, *now),
            question.barred,
            tuple(Step(step.epoch - 1, step.action) for step in steps if step.epoch > 1),
            cost - spent,
            pays,
            proved,
        )
        plan = named_steps(self._task, self._discount, steps)
        return Advice(plan, None, cost, pays, proved)
