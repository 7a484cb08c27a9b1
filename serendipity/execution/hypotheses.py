"""Goal hypotheses: for each goal that the person may have, what they follow then, and help for them.

Robots spoil nothing that a person is on the way to (see :mod:`.guard`), whichever of the goals is theirs.
But people stray, and may need then what robots have taken to help them with.  As long as the person's way
is dearer than it would be had robots done nothing, robots' own work counts for nothing.

Where a deadline comes first, :class:`serendipity.LimitReachedError` is raised.
"""

from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf

from search import PreparedTask
from search.modes.simulation.companion import Companion
from search.modes.simulation.simulator import Simulation
from serendipity.execution.advice import Advice, Adviser, Allows, DecisionPoint, ReactiveAdviser
from serendipity.execution.guard import Following, RobotActions
from serendipity.execution.session_adviser import SessionAdviser
from serendipity.execution.unbound import Unbound
from serendipity.facade.results import named_steps
from serendipity.model import Condition, Deadline, HumanPlan, Options, PlanStep, Step, Task
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


@dataclass(frozen=True, slots=True)
class Prospect:
    """One of the goals that the person may have, and the best plan for it.

    Attributes:
        goal: index of the goal.
        hypothesis: what is so if it is theirs.
        advice: the plan, from the present state; None where there was none in time.
        weight: how probable the goal is.
    """

    goal: int
    hypothesis: Hypothesis
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
        return self.hypothesis.following.alone


def best_for_all(prospects: Sequence[Prospect], deadline: Deadline) -> Prospect | None:
    """The prospect whose robots' part costs least in the mean over all goals; None if none beats waiting.

    Robots' actions are played against the person with each of the goals, by what is known of how they
    react.  Once people with different goals do different things, robots go on as it is best for those who
    do the same: with that plan, with another one, or not at all.
    """
    played = _Played(prospects, deadline)
    best: Prospect | None = None
    least: Fraction | float = sum((p.weight * (p.alone or 0) for p in prospects), Fraction(0))
    for prospect in prospects:
        if prospect.pays and (cost := played.mean(prospect, least)) < least:
            best, least = prospect, cost
    waits = best is not None and played.begins(best) and played.mean(None, least) < least
    return None if waits else best


_Robots = tuple[Step, ...]
"""What robots do."""


class _Played:
    """Robots' parts of some plans, played against the person with each goal."""

    def __init__(self, prospects: Sequence[Prospect], deadline: Deadline) -> None:
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

    def begins(self, chosen: Prospect) -> bool:
        """Whether a prospect's part begins in the epoch that is to come."""
        return any(step.epoch == 1 for step in self._part(chosen))

    def mean(self, chosen: Prospect | None, least: Fraction | float) -> Fraction | float:
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

    def _part(self, prospect: Prospect) -> _Robots:
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
            one = self._prospects[i].hypothesis
            start = one.following.start_of(one.companion.human)
            found = self._known[i, part] = one.companion.played(start, part, self._deadline)
            self._deadline.check()
        return found


def _alike(some: Sequence[object], others: Sequence[object]) -> int:
    """How many epochs begin both."""
    return next(
        (i for i, (a, b) in enumerate(zip(some, others, strict=False)) if a != b), min(len(some), len(others))
    )
