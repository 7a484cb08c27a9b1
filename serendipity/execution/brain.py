"""The robots' side: what they know of the person, and what they decide in each epoch."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Final

from serendipity.execution.adviser import Adviser
from serendipity.execution.beliefs import Beliefs
from serendipity.execution.decided import Decided
from serendipity.execution.outlook import Outlook
from serendipity.execution.promises import Promises
from serendipity.execution.prospects import Prospect, best_for_all
from serendipity.execution.words import Words
from serendipity.execution.world import World
from serendipity.model.answers.result import Result
from serendipity.model.errors import LIMITS
from serendipity.model.numbers import Number
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import PlanStep
from serendipity.model.task.task import Task

if TYPE_CHECKING:
    from serendipity.recognition import GoalsGiven


_TIME_TO_TELL: Final = 0.5
"""The share of the time that has to be left for finding out why nothing is done."""


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
        self._out: frozenset[int] = frozenset()
        self._beliefs = None if goals is None else Beliefs.about(task, goals, beta)
        conditions = [task.goal] if self._beliefs is None else [c.goal for c in self._beliefs.candidates]
        tasks = [task if goal == task.goal else task.with_goal(goal) for goal in conditions]
        self._promises = Promises(tasks, strict=options.strict, told=told)
        self._advisers = [Adviser(one, options) for one in tasks]
        self._words = Words(task, self._beliefs)
        self._human = task.agents[task.human]
        self._agents = {name: i for i, name in enumerate(task.agents)}

    @property
    def goals(self) -> dict[str, float]:
        """The posterior of each candidate goal; empty where there is only one."""
        return {} if self._beliefs is None else self._beliefs.named()

    # -- what robots learn

    def saw(self, own: int | None, executed: Sequence[int]) -> None:
        """Take in an epoch: what the person did alone, and everything that took place."""
        self._promises.acted(own)
        if self._beliefs is not None:
            self._beliefs.saw(own, executed)

    def surprised(self) -> None:
        """The world is other than what actions have made it."""
        if self._beliefs is not None:
            self._beliefs.disturbed()

    def drop(self, robots: Iterable[int]) -> None:
        """Robots are out of order: nothing that they take part in is possible any more."""
        self._out |= self._promises.hands.of(tuple(robots))

    # -- what they decide

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """What robots do in the epoch that is to come.

        Raises:
            LimitReachedError: the deadline came first; robots had better do nothing.
        """
        world = outlook.world
        weights = self._weights(world.state, deadline)
        off = self._promises.look(world.state, weights, deadline)
        if not off:
            return self._idle(outlook, "aside", self._words.hopeless())
        weights = {goal: weights[goal] for goal in off}
        untouched = frozenset[int]().union(*off.values())
        running = [step for step in outlook.running if world.of(step) not in untouched]
        if self._promises.broken_by(running, (), world, weights, deadline) is not None:
            running = []
        busy = [self._agents[name] for step in outlook.running for name in step.agents]
        unable = self._out | self._promises.hands.of(busy)
        removed = untouched | unable
        while not self._promises.hands.all <= removed:
            prospect = self._planned(world, removed, weights, deadline)
            if prospect is None:
                torn = self._torn(world, {goal: unable | own for goal, own in off.items()}, deadline)
                return self._idle(outlook, *(self._words.unsure() if torn else self._words.nothing()))
            own, offers = self._now(outlook, prospect)
            broken = self._promises.broken_by([*running, *own], offers, world, weights, deadline)
            if broken is None:
                return self._decided(outlook, prospect, [*running, *own], offers)
            if broken in running:
                running.remove(broken)
            else:
                removed |= {world.of(broken)}
        return self._idle(outlook, "aside", self._words.helpless(), running)

    def _weights(self, state: frozenset[int], deadline: Deadline) -> dict[int, Fraction]:
        """The goals that the person may have, with their probabilities."""
        if self._beliefs is None:
            return {0: Fraction(1)}
        self._beliefs.update(state, deadline)
        return {goal: self._beliefs.weights[goal] for goal in self._beliefs.possible()}

    def _planned(
        self, world: World, removed: frozenset[int], weights: dict[int, Fraction], deadline: Deadline
    ) -> Prospect | None:
        """The plan that costs least in the mean over the goals, or None where idling costs no more."""
        total = sum(weights.values())
        prospects = []
        for goal, weight in weights.items():
            following = self._promises.to(goal)
            result = self._advised(goal, world, removed, deadline)
            if result is not None:
                promise = following.promise()
                prospects.append(Prospect(goal, result, following.prepared, promise, weight / total))
        certain = len(weights) == 1 and prospects
        return prospects[0] if certain else best_for_all(prospects, self._options, deadline)

    def _advised(self, goal: int, world: World, removed: frozenset[int], deadline: Deadline) -> Result | None:
        """The best plan for a goal; None where the person has nothing left to do for it."""
        following = self._promises.to(goal)
        names = [following.task.actions[i].name for i in following.promise()]
        return self._advisers[goal].advise(world.state, names, removed, deadline) if names else None

    def _torn(self, world: World, removed: dict[int, frozenset[int]], deadline: Deadline) -> bool:
        """Whether help would pay if it were known which goal it is; taken for no if time does not tell."""
        left = deadline.left()
        if len(removed) < 2 or (left is not None and left < _TIME_TO_TELL * (left + deadline.elapsed())):
            return False
        try:
            advised = (self._advised(goal, world, off, deadline) for goal, off in removed.items())
            return any(result is not None and result.opportunity for result in advised)
        except LIMITS:
            return False

    def _now(self, outlook: Outlook, prospect: Prospect) -> tuple[list[PlanStep], tuple[PlanStep, ...]]:
        """What robots do by themselves in the first epoch of a plan, and what they offer."""
        human = self._human
        now = [PlanStep(outlook.epoch, s.agents, s.action, s.cost) for s in prospect.plan if s.epoch == 1]
        offers = tuple(step for step in now if human in step.agents and len(step.agents) > 1)
        return [step for step in now if human not in step.agents], offers

    def _decided(
        self,
        outlook: Outlook,
        prospect: Prospect,
        ready: Sequence[PlanStep],
        offers: tuple[PlanStep, ...],
    ) -> Decided:
        his = (step for step in prospect.plan if step.epoch == 1 and self._human in step.agents)
        verdict, reason = self._words.decided(outlook.epoch, prospect, [*ready, *offers])
        return Decided(
            outlook.epoch,
            verdict,
            reason,
            actions=tuple(ready),
            offers=offers,
            expected=next(his, None),
            plan=prospect.plan,
            window=prospect.result.window,
            cost=sum(step.cost for step in prospect.plan),
            alone=float(prospect.alone),
            goals=self.goals,
        )

    def _idle(self, outlook: Outlook, verdict: str, reason: str, running: Sequence[PlanStep] = ()) -> Decided:
        """No plan: at most something that was begun is finished."""
        if running:
            verdict, reason = "helps", self._words.finishes(running[0])
        return Decided(outlook.epoch, verdict, reason, actions=tuple(running), goals=self.goals)
