"""Goal hypotheses: for each goal that the person may have, what they follow then, and help for them.

Robots spoil nothing that a person is on the way to (see :mod:`.guard`), whichever of the goals is theirs.
But people stray, and may need then what robots have taken to help them with.  As long as the person's way
is dearer than it would be had robots done nothing, robots' own work counts for nothing.

Where a deadline comes first, :class:`serendipity.LimitReachedError` is raised.
"""

from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from fractions import Fraction

from search import PreparedTask
from search.modes.simulation.companion import Companion
from serendipity.execution.advice import Advice, Adviser, Allows, DecisionPoint, ReactiveAdviser
from serendipity.execution.guard import Following, RobotActions
from serendipity.execution.session_adviser import SessionAdviser
from serendipity.execution.unbound import Unbound
from serendipity.facade.results import named_steps
from serendipity.model import Condition, Deadline, HumanPlan, Options, Step, Task
from serendipity.model.answers.simulation import Simulation
from serendipity.model.errors import LIMITS
from serendipity.model.numbers import total
from serendipity.model.task.execution import actions_of, steps_named


class Hypothesis:
    """One goal.

    Args:
        actions: what robots can do.
        state: ids of the facts that are true, as the person knows.
        deadline: polled while tables are built.
        others: ids of actions that may pay if another goal is theirs.
        told: the person keeps to the robots' plan.

    Attributes:
        companion: plans for them, and plays what becomes of plans.
        following: what they may be following.
        adviser: what robots had best do.
        unbound: what they could do if they had promised nothing.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        actions: RobotActions,
        state: frozenset[int],
        deadline: Deadline,
        others: frozenset[int] = frozenset(),
        *,
        told: bool,
    ) -> None:
        omniscient = options.human_model == "omniscient"
        model = options.but(mode="serendipity", human_model="observant") if omniscient else options
        prepared = PreparedTask(task.at(state, deadline))
        pointless = others - useful(prepared, deadline) if others else others
        by_session = bool(omniscient or task.robot_goal)
        self.task = task
        self.companion = Companion(prepared, model, deadline, others)
        self.following = Following(self.companion.human, state, model)
        self.adviser: Adviser = (
            SessionAdviser(task, options, actions, told=told)
            if by_session
            else ReactiveAdviser(task, options.discount, self.companion, actions, pointless)
        )
        self.unbound = Unbound(task, options, None if by_session else self.companion)
        self._discount = options.discount
        self._selfless: Adviser | None = None

        def selfless(deadline: Deadline) -> Adviser:
            """An adviser for whom robots' work costs nothing, and their own goals can wait."""
            if by_session:
                free = task.with_goal(task.goal, Condition())
                return SessionAdviser(free, options.but(discount=1), actions, told=told)
            companion = Companion(prepared, model.but(discount=1), deadline, others)
            return ReactiveAdviser(task, Fraction(1), companion, actions)

        self._make_selfless = selfless

    def again(self) -> "Hypothesis":
        """The same, with the same tables, which goes its own way from here."""
        other = copy(self)
        other.following, other.adviser = copy(self.following), copy(self.adviser)
        other._selfless = copy(self._selfless)
        return other

    @property
    def alone(self) -> Fraction | None:
        """What the person pays without help; None where they have no plan."""
        return self.following.alone

    def played(self, part: Sequence[Step], deadline: Deadline) -> Simulation:
        """What becomes of what robots do, beside the person with this goal."""
        return self.companion.played(self.following.start_of(self.companion.human), part, deadline)

    def owed(self, untouched: frozenset[int], state: frozenset[int]) -> Fraction:
        """How much dearer the person's way has become; nothing where there is none, or none would be.

        Args:
            untouched: ids of the facts that would be true if robots had done nothing.
            state: ids of those that are.
        """
        if untouched == state:
            return Fraction(0)
        before, now = map(self.following.cost_alone, (untouched, state))
        return Fraction(0) if before is None or now is None else max(now - before, Fraction(0))

    def amends(self, now: DecisionPoint, deadline: Deadline) -> Advice | None:
        """The plan by which the person pays least, whatever robots do for it; None: none beats idling."""
        if self._selfless is None:
            self._selfless = self._make_selfless(deadline)
        advice = self._selfless.advise(self.following, now, deadline)
        if advice is None or not advice.pays:
            return None
        steps = steps_named(self.task, advice.plan)
        cost = total(self.task.team_cost(a, self._discount) for a in actions_of(self.task, steps))
        return replace(advice, plan=named_steps(self.task, self._discount, steps), cost=cost)


class Hypotheses:
    """The goals that the person may have, each looked into when it is asked about first.

    Args:
        tasks: the task with each of the goals.
        told: the person keeps to the robots' plan: then there is nothing to promise.
        surely: whether robots manage whatever is possible.
        habits: for each goal, the plan to it that the person would follow, whatever else there is.

    Attributes:
        actions: what robots can do.
        habits: by goal, what is left of those that they may still be following.
    """

    def __init__(
        self,
        tasks: Sequence[Task],
        options: Options,
        *,
        told: bool,
        surely: bool,
        habits: Sequence[HumanPlan] = (),
    ) -> None:
        self.actions = RobotActions(tasks[0])
        self._tasks = tasks
        self._options = options
        self._told = told
        self._surely = surely
        self._known: dict[int, Hypothesis] = {}
        self._useful: frozenset[int] | None = None
        self._habitual = frozenset[int]().union(*habits)
        self.habits = dict(enumerate(habits))

    def again(self) -> "Hypotheses":
        """The same, with the same tables, which go their own way from here."""
        other = copy(self)
        other._known = {goal: known.again() for goal, known in self._known.items()}
        return other

    def __getitem__(self, goal: int) -> Hypothesis:
        """The hypothesis of a goal that was looked into."""
        return self._known[goal]

    def acted(self, own: int | None, executed: Sequence[int], tried: int | None) -> None:
        """Say what the person did, as :class:`.guard.Following` takes it."""
        for known in self._known.values():
            known.following.acted(own, executed, tried)

    def go_on(self, his: str | None, *, in_vain: bool) -> set[int]:
        """Say what the person did, by its name; the goals whose habit was another.  Who waits is late."""
        if his is None:
            return set()
        actions = self._tasks[0].actions
        same = {goal: plan for goal, plan in self.habits.items() if plan and actions[plan[0]].name == his}
        self.habits = {goal: plan if in_vain else plan[1:] for goal, plan in same.items()}
        return set(range(len(self._tasks))).difference(self.habits)

    def surprised(self) -> None:
        """The world is other than what actions have made it, and everybody knows."""
        self._known = {}

    def look(self, state: frozenset[int], goals: Iterable[int], deadline: Deadline) -> list[int]:
        """The person looks up; those goals that they can reach alone.

        Args:
            state: ids of the facts that are true.
            goals: those that the person may have.
            deadline: polled, now and for as long as the hypotheses are asked about.
        """
        found = []
        for goal in goals:
            if goal not in self._known:
                self._known[goal] = self._supposed(goal, state, deadline)
            self._known[goal].companion.under(deadline)
            self._known[goal].following.look(state, self.habits.get(goal))
            if not self._known[goal].following.hopeless:
                found.append(goal)
        return found

    def reachable(
        self, state: frozenset[int], goals: Iterable[int], deadline: Deadline, *, must: bool
    ) -> tuple[list[int], bool]:
        """The same, and whether it is known in time; unless it must be known, there may be none of them."""
        try:
            return self.look(state, goals, deadline), True
        except LIMITS:
            if must:
                raise
            return [], False

    def _supposed(self, goal: int, state: frozenset[int], deadline: Deadline) -> Hypothesis:
        if self._useful is None:
            several = self._tasks if len(self._tasks) > 1 else ()
            self._useful = self._habitual.union(*(useful(PreparedTask(t), deadline) for t in several))
        others, told = self._useful, self._told
        return Hypothesis(self._tasks[goal], self._options, self.actions, state, deadline, others, told=told)

    def allows(self, goals: Iterable[int], beside: Sequence[int] = ()) -> Allows:
        """What may happen in the epoch that is to come, whichever of some goals the person has.

        Args:
            beside: ids of what robots do in any case.
        """
        human, actions = self._tasks[0].human, self._tasks[0].actions
        following = [self._known[goal].following for goal in goals]
        known: dict[tuple[int, ...], bool] = {}

        def allowed(chosen: Sequence[int]) -> bool:
            others = tuple(sorted(i for i in chosen if actions[i].participants != (human,)))
            found = known.get(others)
            if found is None:
                offers = [i for i in others if human in actions[i].participants]
                robots = [*beside, *(i for i in others if human not in actions[i].participants)]
                found = known[others] = not any(
                    one.spoilt(robots, offers, surely=self._surely) for one in following
                )
            return found

        return (lambda _: True) if self._told else allowed


def useful(prepared: PreparedTask, deadline: Deadline) -> frozenset[int]:
    """Ids of the actions that contribute something to a task's goal, or to what a person does about it."""
    return frozenset(prepared.with_diversions(deadline).packed.useful)
