"""The robots' side: what they know of the person, and what they decide in each epoch."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from search import PreparedTask
from serendipity.execution.adviser import Adviser
from serendipity.execution.beliefs import Beliefs
from serendipity.execution.decided import Decided
from serendipity.execution.guard import Following, Hands, Needed
from serendipity.execution.prospects import Prospect, best_for_all
from serendipity.execution.words import Words
from serendipity.execution.world import World
from serendipity.model.numbers import Number
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import PlanStep
from serendipity.model.task.task import Task

if TYPE_CHECKING:
    from serendipity.recognition import GoalsGiven


class Outlook(NamedTuple):
    """What robots see when they decide.

    Attributes:
        epoch: the epoch that is to come.
        world: the world.
        running: what they have begun and not finished.
    """

    epoch: int
    world: World
    running: tuple[PlanStep, ...]


@dataclass(frozen=True, slots=True)
class _Course:
    """A plan that robots are on.

    Attributes:
        prospect: the plan, for a goal.
        began: the epoch that is its first.
        removed: ids of the actions that it had to do without.
        expected: the state before the next epoch, if all goes as planned.
    """

    prospect: Prospect
    began: int
    removed: frozenset[int]
    expected: frozenset[int]

    def at(self, epoch: int) -> tuple[PlanStep, ...]:
        """What is left of the plan, its epochs counted from the given one."""
        past = epoch - self.began
        steps = self.prospect.result.plan or ()
        return tuple(PlanStep(s.epoch - past, s.agents, s.action, s.cost) for s in steps if s.epoch > past)


class Brain:
    """Recognises, plans, and leaves alone what the person may need.

    Args:
        task: the task.
        options: in force.
        goals: goals that the person may have; None: they are known to have the task's.
        beta: of the posterior.
        told: the person keeps to the robots' plan.
    """

    def __init__(
        self, task: Task, options: Options, goals: "GoalsGiven | None", beta: Number, *, told: bool
    ) -> None:
        self._options = options
        self._told = told
        self._hands = Hands(task)
        self._out: frozenset[int] = frozenset()
        self._beliefs = None if goals is None else Beliefs.about(task, goals, beta)
        conditions = [task.goal] if self._beliefs is None else [c.goal for c in self._beliefs.candidates]
        tasks = [task if goal == task.goal else task.with_goal(goal) for goal in conditions]
        self._following = [Following(PreparedTask(one), strict=options.strict) for one in tasks]
        self._advisers = [Adviser(one, options) for one in tasks]
        self._words = Words(task, self._beliefs)
        self._course: _Course | None = None
        self._human = task.agents[task.human]
        self._agents = {name: i for i, name in enumerate(task.agents)}

    @property
    def goals(self) -> dict[str, float]:
        """The posterior of each candidate goal; empty where there is only one."""
        return {} if self._beliefs is None else self._beliefs.named()

    # -- what robots learn

    def saw(self, own: int | None, executed: Sequence[int]) -> None:
        """Take in an epoch: what the person did alone, and everything that took place."""
        for following in self._following:
            following.acted(own)
        if self._beliefs is not None:
            self._beliefs.saw(own, executed)

    def surprised(self) -> None:
        """The world is other than what actions have made it."""
        self._course = None
        if self._beliefs is not None:
            self._beliefs.disturbed()

    def drop(self, robots: Iterable[int]) -> None:
        """Robots are out of order: nothing that they take part in is possible any more."""
        self._out |= self._hands.of(tuple(robots))
        self._course = None

    def forget(self) -> None:
        """Give up the plan that robots are on."""
        self._course = None

    # -- what they decide

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """What robots do in the epoch that is to come.

        Raises:
            LimitReachedError: the deadline came first; robots had better do nothing.
        """
        world = outlook.world
        weights = self._weights(world.state, deadline)
        needed = Needed()
        for goal in weights:
            needed |= self._following[goal].look(world.state, deadline)
        weights = {goal: weight for goal, weight in weights.items() if not self._following[goal].hopeless}
        if not weights:
            return self._idle(outlook, "aside", self._words.hopeless())
        off = frozenset[int]() if self._told else self._hands.off(needed)
        busy = [self._agents[name] for step in outlook.running for name in step.agents]
        removed = off | self._out | self._hands.of(busy)
        running = [step for step in outlook.running if world.of(step) not in off]
        while True:
            course = self._on_course(outlook, removed, weights)
            if course is None:
                prospects = [self._prospect(goal, weights, world, removed, deadline) for goal in weights]
                one = len(prospects) == 1
                best = prospects[0] if one else best_for_all(prospects, self._options, deadline)
                if best is None:
                    unsure = any(p.result.opportunity for p in prospects)
                    return self._idle(outlook, *(self._words.unsure() if unsure else self._words.nothing()))
                course = _Course(best, outlook.epoch, removed, world.state)
            plan = course.at(outlook.epoch)
            own, offers = self._now(outlook, plan)
            ready = [*running, *own]
            spoiling = None if self._told else self._spoiling(ready, offers, world, weights, deadline)
            if spoiling is None:
                return self._decided(outlook, course, plan, ready, offers)
            if spoiling in running:
                running.remove(spoiling)
            else:
                removed |= {world.of(spoiling)}

    def _weights(self, state: frozenset[int], deadline: Deadline) -> dict[int, Fraction]:
        """The goals that the person may have, with their probabilities."""
        if self._beliefs is None:
            return {0: Fraction(1)}
        self._beliefs.update(state, deadline)
        return {goal: self._beliefs.weights[goal] for goal in self._beliefs.possible()}

    def _on_course(
        self, outlook: Outlook, removed: frozenset[int], weights: dict[int, Fraction]
    ) -> _Course | None:
        """The plan that robots are on, where nothing has changed that could make another one better."""
        course = self._course
        if course is None or len(weights) > 1 or course.prospect.goal not in weights:
            return None
        proved = course.prospect.result.status == "optimal"
        same = course.expected == outlook.world.state and course.removed == removed
        return course if proved and same else None

    def _prospect(
        self,
        goal: int,
        weights: dict[int, Fraction],
        world: World,
        removed: frozenset[int],
        deadline: Deadline,
    ) -> Prospect:
        following = self._following[goal]
        promise = following.promise()
        names = [following.task.actions[i].name for i in promise]
        result = self._advisers[goal].advise(world.state, names, removed, deadline)
        share = weights[goal] / sum(weights.values())
        return Prospect(goal, result, following.prepared, promise, share)

    def _now(self, outlook: Outlook, plan: Sequence[PlanStep]) -> tuple[list[PlanStep], tuple[PlanStep, ...]]:
        """What robots do by themselves in the first epoch of a plan, and what they offer."""
        human = self._human
        now = [PlanStep(outlook.epoch, s.agents, s.action, s.cost) for s in plan if s.epoch == 1]
        offers = tuple(step for step in now if human in step.agents and len(step.agents) > 1)
        return [step for step in now if human not in step.agents], offers

    def _spoiling(
        self,
        own: Sequence[PlanStep],
        offers: Sequence[PlanStep],
        world: World,
        weights: Iterable[int],
        deadline: Deadline,
    ) -> PlanStep | None:
        """The first of some steps that could make it dearer for the person, beside those before it."""
        ready = [world.of(step) for step in offers]
        actions = [world.of(step) for step in own]
        for count, step in enumerate(own, start=1):
            if any(self._following[goal].spoilt(actions[:count], ready, deadline) for goal in weights):
                return step
        return None

    def _decided(
        self,
        outlook: Outlook,
        course: _Course,
        plan: tuple[PlanStep, ...],
        ready: Sequence[PlanStep],
        offers: tuple[PlanStep, ...],
    ) -> Decided:
        world, prospect = outlook.world, course.prospect
        now = [step for step in plan if step.epoch == 1]
        expected = next((step for step in now if self._human in step.agents), None)
        after = world.after(world.of(step) for step in now)
        self._course = _Course(prospect, course.began, course.removed, after)
        verdict, reason = self._words.decided(outlook, prospect, plan, [*ready, *offers])
        return Decided(
            outlook.epoch,
            verdict,
            reason,
            actions=tuple(ready),
            offers=offers,
            expected=expected,
            plan=plan,
            window=prospect.result.window if course.began == outlook.epoch else None,
            cost=sum(step.cost for step in plan),
            alone=float(prospect.alone) if course.began == outlook.epoch else None,
            goals=self.goals,
        )

    def _idle(self, outlook: Outlook, verdict: str, reason: str) -> Decided:
        self._course = None
        return Decided(outlook.epoch, verdict, reason, goals=self.goals)
