"""What robots owe a person whose way they have made dearer, and how they make up for it.

Robots spoil nothing that a person is on the way to.  But people stray, and may need then what robots
have taken to help them with.  So robots keep in mind what would be true had they done nothing, and as
long as the person's way is dearer than from there, robots' own work counts for nothing.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace
from fractions import Fraction

from search import PreparedTask
from search.modes.simulation.companion import Companion
from search.modes.simulation.space import Start
from search.packed.cost_vector import INFINITE_KEY
from serendipity.execution.advice import Advice, Adviser, Question
from serendipity.facade.results import named_steps
from serendipity.model.numbers import total
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import actions_of, steps_named
from serendipity.model.task.task import Task


class Untouched:
    """What would be true if robots had done nothing since the person last took something from them.

    Args:
        task: the task.

    Attributes:
        state: ids of the facts that would be true.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self.state = task.init
        self._known = False

    def saw(self, own: int | None, executed: Sequence[int]) -> None:
        """Take in an epoch: what the person did alone, and everything that took place, by action ids."""
        actions = self._task.actions
        if any(self._task.human in actions[i].participants for i in executed if i != own):
            self._known = False
        elif own is not None:
            self._known &= actions[own].applicable(self.state)
            self.state = apply(self.state, actions[own])

    def forget(self) -> None:
        """What is true has changed otherwise."""
        self._known = False

    def look(self, state: frozenset[int]) -> None:
        """Say which facts are true, by their ids."""
        if not self._known:
            self.state, self._known = state, True


class Amends:
    """Makes up for what robots have done.

    Args:
        task: the task.
        discount: of robots' costs.
        companion: plays the person.
        selfless: plans as if what robots do cost nothing.
    """

    def __init__(self, task: Task, discount: Fraction, companion: Companion, selfless: Adviser) -> None:
        self._task = task
        self._discount = discount
        self._companion = companion
        self._selfless = selfless

    def again(self) -> "Amends":
        """The same, which goes its own way from here."""
        return Amends(self._task, self._discount, self._companion, self._selfless.again())

    def owed(self, untouched: frozenset[int], state: frozenset[int]) -> Fraction:
        """How much dearer the person's way has become; nothing where there is none, or none would be.

        Raises:
            LimitReachedError: the deadline came first; so do other methods.
        """
        if untouched == state:
            return Fraction(0)
        human = self._companion.human
        before, now = (human.alone.key(human.packed.pack(s)) for s in (untouched, state))
        if INFINITE_KEY in (before, now):
            return Fraction(0)
        return max(human.keys.cost(now) - human.keys.cost(before), Fraction(0))

    def advise(self, question: Question, deadline: Deadline) -> Advice | None:
        """The plan by which the person pays least, whatever robots do for it; None: none beats idling."""
        advice = self._selfless.advise(question, deadline)
        if advice is None or not advice.pays:
            return None
        steps = steps_named(self._task, advice.plan)
        cost = total(self._task.team_cost(a, self._discount) for a in actions_of(self._task, steps))
        return replace(advice, plan=named_steps(self._task, self._discount, steps), cost=cost)


class Selfless:
    """An adviser beside a person who replans, for whom robots' work costs nothing.

    Args:
        task: the task.
        prepared: the same made ready.
        options: in force.
        actions: ids of actions that contribute nothing to the goal, and are played all the same.
    """

    def __init__(
        self, task: Task, prepared: PreparedTask, options: Options, actions: Collection[int]
    ) -> None:
        self._task = task
        self._prepared = prepared
        self._options = options.but(discount=1)
        self._actions = actions
        self._companion: Companion | None = None

    def again(self) -> "Selfless":
        """See :class:`serendipity.execution.advice.Adviser`."""
        return self

    def advise(self, question: Question, deadline: Deadline) -> Advice | None:
        """See :class:`serendipity.execution.advice.Adviser`."""
        if self._companion is None:
            self._companion = Companion(self._prepared, self._options, deadline, self._actions)
        human, start = self._companion.under(deadline), question.following.start
        same = Start(start.state, start.belief, human.intentions.of(start.intention.actions))
        course = self._companion.course(same, [question.barred], deadline, begins=question.allows)
        if course is None:
            return None
        plan = named_steps(self._task, self._options.discount, course.steps)
        return Advice(plan, None, course.cost, course.pays, course.proved)
