"""The robots' side: what they know of the person, and what they decide in each epoch."""

from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Final

from serendipity.execution.advice import Allows, Question
from serendipity.execution.beliefs import Beliefs
from serendipity.execution.decided import Decided
from serendipity.execution.outlook import Outlook
from serendipity.execution.promises import Promises
from serendipity.execution.prospects import Prospect, best_for_all
from serendipity.execution.words import Words
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

_TIME_TO_WEIGH: Final = 0.4
"""The share of the time that is kept for what comes after planning."""

_TIME_TO_RECOGNISE: Final = 0.4
"""The share of the time that recognition may take; the posterior of an earlier epoch has to do otherwise."""


@dataclass(frozen=True, slots=True)
class _Asked:
    """What all goals have in common in an epoch.

    Attributes:
        state: ids of the facts that are true.
        barred: ids of actions that nobody may do.
        allows: what may happen in the epoch.
        weights: how probable each goal is.
    """

    state: frozenset[int]
    barred: frozenset[int]
    allows: Allows
    weights: dict[int, Fraction]


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
        self._promises = Promises(tasks, options, told=told)
        self._words = Words(task, self._beliefs)
        self._human = task.agents[task.human]
        self._agents = {name: i for i, name in enumerate(task.agents)}

    @property
    def goals(self) -> dict[str, float]:
        """The posterior of each candidate goal; empty where there is only one."""
        return {} if self._beliefs is None else self._beliefs.named()

    def again(self) -> "Brain":
        """The same robots, who know what these know, and go their own way from here; their goal is known."""
        assert self._beliefs is None, "what is known of several goals is not told twice"
        other = copy(self)
        other._promises = self._promises.again()
        return other

    # -- what robots learn

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """See :class:`serendipity.execution.Robots`."""
        self._promises.acted(own, executed, tried)
        if self._beliefs is not None:
            self._beliefs.saw(own, executed)

    def surprised(self) -> None:
        """The world is other than what actions have made it."""
        self._promises.surprised()
        if self._beliefs is not None:
            self._beliefs.disturbed()

    def drop(self, robots: Iterable[int]) -> None:
        """Robots are out of order: nothing that they take part in is possible any more."""
        self._out |= self._promises.hands.of(tuple(robots))

    def unable(self, actions: Iterable[int]) -> None:
        """See :class:`serendipity.execution.Robots`."""
        self._out |= frozenset(actions)

    # -- what they decide

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """What robots do in the epoch that is to come.

        Raises:
            LimitReachedError: the deadline came first; robots had better do nothing.
        """
        world = outlook.world
        weights = self._weights(world.state, deadline)
        goals = self._promises.look(world.state, weights, deadline)
        if not goals:
            return self._idle(outlook, "aside", self._words.hopeless())
        running = self._going_on(outlook, goals)
        busy = [self._agents[name] for step in outlook.running for name in step.agents]
        barred = self._out | self._promises.hands.of(busy)
        if self._promises.hands.all <= barred:
            return self._idle(outlook, "aside", self._words.helpless(), running)
        allows = self._promises.allows(goals, [world.of(step) for step in running])
        asked = _Asked(world.state, barred, allows, {goal: weights[goal] for goal in goals})
        prospects = self._planned(asked, deadline.sooner(_TIME_TO_WEIGH))
        certain = len(prospects) == 1
        if certain and prospects[0].advice is None:
            return self._idle(outlook, "aside", self._words.helpless(), running)
        prospect = prospects[0] if certain else best_for_all(prospects, deadline)
        if prospect is None:
            torn = self._torn(asked, prospects, deadline)
            return self._idle(outlook, *(self._words.unsure() if torn else self._words.nothing()), running)
        own, offers = self._now(outlook, prospect)
        return self._decided(outlook, prospect, [*running, *own], offers)

    def _weights(self, state: frozenset[int], deadline: Deadline) -> dict[int, Fraction]:
        """The goals that the person may have, with their probabilities, the most probable first."""
        if self._beliefs is None:
            return {0: Fraction(1)}
        try:
            self._beliefs.update(state, deadline.part(_TIME_TO_RECOGNISE))
        except LIMITS:
            deadline.check()  # what was known before still tells something
        weights = self._beliefs.weights
        return {goal: weights[goal] for goal in sorted(self._beliefs.possible(), key=lambda g: -weights[g])}

    def _going_on(self, outlook: Outlook, goals: Sequence[int]) -> list[PlanStep]:
        """What was begun and may still be finished."""
        running: list[PlanStep] = []
        allows = self._promises.allows(goals)
        for step in outlook.running:
            if allows([outlook.world.of(other) for other in (*running, step)]):
                running.append(step)
        return running

    def _planned(self, asked: "_Asked", deadline: Deadline) -> list[Prospect]:
        """A prospect for each goal; goals that hardly matter get what time is left."""
        total = sum(asked.weights.values())
        prospects = []
        for number, (goal, weight) in enumerate(asked.weights.items()):
            imagined = self._promises.to(goal)
            question = Question(asked.state, imagined.following, asked.barred, asked.allows)
            try:
                share = deadline.part(1 / (len(asked.weights) - number))
                advice = imagined.adviser.advise(question, share)
            except LIMITS:
                if len(asked.weights) == 1:
                    raise
                advice = None
            imagined.companion.under(deadline)
            prospects.append(Prospect(goal, imagined, advice, weight / total))
        return prospects

    def _torn(self, asked: "_Asked", prospects: Sequence[Prospect], deadline: Deadline) -> bool:
        """Whether help would pay if it were known which goal it is; taken for no if time does not tell."""
        if len(prospects) < 2 or any(prospect.pays for prospect in prospects):
            return len(prospects) > 1
        left = deadline.left()
        if left is not None and left < _TIME_TO_TELL * (left + deadline.elapsed()):
            return False
        try:
            return any(self._pays_alone(asked, prospect, deadline) for prospect in prospects)
        except LIMITS:
            return False

    def _pays_alone(self, asked: "_Asked", prospect: Prospect, deadline: Deadline) -> bool:
        """Whether help would pay if a goal were the only one."""
        imagined, allows = prospect.imagined, self._promises.allows([prospect.goal])
        question = Question(asked.state, imagined.following, asked.barred, allows)
        advice = imagined.adviser.advise(question, deadline)
        return advice is not None and advice.pays

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
            window=None if prospect.advice is None else prospect.advice.window,
            cost=sum(step.cost for step in prospect.plan),
            alone=float(prospect.alone),
            proved=prospect.advice is not None and prospect.advice.proved,
            goals=self.goals,
        )

    def _idle(self, outlook: Outlook, verdict: str, reason: str, running: Sequence[PlanStep] = ()) -> Decided:
        """No plan: at most something that was begun is finished."""
        if running:
            verdict, reason = "helps", self._words.finishes(running[0])
        return Decided(outlook.epoch, verdict, reason, actions=tuple(running), goals=self.goals)
