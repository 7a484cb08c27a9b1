"""A plan in time, played beside somebody who replans, epoch by epoch (semantics 6, 10.6)."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction

from serendipity.facade.person.follower import Follower
from serendipity.facade.person.sight import Sight
from serendipity.facade.person.ways import Ways, entries_of
from serendipity.facade.results import named_steps
from serendipity.model import Deadline, HumanPlan, Options, PlanStep, Step, Task
from serendipity.model.answers.simulation import (
    CONFLICT,
    INAPPLICABLE,
    REFUSED,
    SimulatedEpoch,
    Simulation,
    Skipped,
)
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.execution import actions_named
from serendipity.model.task.passing import at_work, epoch_later
from serendipity.model.task.plans import PlanEntry


def played_in_time(
    task: Task,
    options: Options,
    plan: Sequence[PlanEntry],
    steps: Iterable[Step],
    *,
    horizon: int | None,
    deadline: Deadline,
    mind: Follower | None = None,
    local: bool = False,
) -> Simulation:
    """The robots' part of a plan, played beside a person who looks up when they are free.

    Args:
        options: discount, interference, head start, and what waiting costs.
        plan: their plan at the beginning, with its epochs; empty where they have none.
        steps: the plan, by ids; what it wants the person to do alone is not looked at.
        horizon: ``T``, or None for any.
        mind: what they mean to do and believe, instead of a plan.
        local: whether they see only what is where they are, where there is no ``mind``.

    Raises:
        LimitReachedError: the deadline ran out in the first epoch.
    """
    if mind is None:
        mind = Follower(Ways(options), sight=Sight(task) if local else None)
        mind.rest = entries_of(task, task.plan_from_names(plan)) if plan else ()
    game = _Game(task, options, mind, steps, deadline)
    epochs: list[SimulatedEpoch] = []
    limit = None
    while not game.over(len(epochs)) and (horizon is None or len(epochs) < horizon):
        try:
            deadline.check()
            epochs.append(game.epoch(len(epochs) + 1))
        except LIMITS as error:
            if not epochs:
                raise
            limit = limit_reason(error)
            break
    every = (task.actions[i] for epoch in epochs for i in epoch.executed)
    cost = sum((task.team_cost(action, options.discount) for action in every), Fraction(0))
    cost += options.waiting_cost * game.paid_for
    return Simulation(tuple(epochs), game.done, cost, limit)


class _Game:
    """The task as it stands, and the person's mind.

    Attributes:
        paid_for: epochs of waiting that the person has paid for, since they began something after them.
    """

    def __init__(
        self, task: Task, options: Options, mind: Follower, steps: Iterable[Step], deadline: Deadline
    ) -> None:
        self._now, self._options, self._deadline = task, options, deadline
        self._mind, self._ways = mind, mind.ways
        self._left: dict[int, list[int]] = defaultdict(list)
        for step in steps:
            if task.actions[step.action].participants != (task.human,):
                self._left[step.epoch].append(step.action)
        self.paid_for = self._waited = 0
        self._saw: tuple[tuple[int, bool], ...] = ()
        self._stuck = False

    @property
    def done(self) -> bool:
        """Whether the goals hold, and the person is at nothing."""
        now = self._now
        held = now.goal.holds(now.init) and now.robot_goal.holds(now.init)
        return held and now.human not in at_work(now)

    def over(self, passed: int) -> bool:
        """Whether after some epochs it is done, or nothing will happen any more."""
        if passed < self._options.head_start:
            return False
        return self.done or (self._stuck and not self._left)

    def epoch(self, number: int) -> SimulatedEpoch:
        """Let an epoch go by."""
        broken = self._broken_off()
        now, mind = self._now, self._mind
        offered = sorted(self._left.pop(number, ()))
        joint = [i for i in offered if now.human in now.actions[i].participants]
        busy = now.human in at_work(now) or number <= self._options.head_start  # when they are not up yet
        if mind.sight is not None:
            self._saw = () if busy else mind.sight.look(now)
        saw, believed = self._saw, now if mind.sight is None else mind.sight.believed
        before = mind.working(believed)
        choice = None if busy else mind.choose(now, self._steps(joint), self._deadline)
        best = mind.working(believed) if busy else self._plan(believed)
        plan, accepted, own = mind.plan(now) or (), None, None
        if isinstance(choice, PlanStep):
            accepted = self._variant(actions_named(now, choice.action, choice.agents))
        elif choice is not None:
            ids = actions_named(now, choice, [now.agents[now.human]])
            own = next((i for i in ids if now.actions[i].applicable(believed.init)), ids[0])
        his = [i for i in (accepted, own) if i is not None]
        if all(now.actions[i].applicable(now.init) for i in his):
            broken += self._broken_off(his)
        elif mind.sight is not None:
            mind.failed(now.actions[his[0]], now)
        failed = self._later(his) is None
        taken = [] if failed else his
        if taken:
            self.paid_for, self._waited = self.paid_for + self._waited, 0
        elif now.human not in at_work(now):
            self._waited += 1
        skipped = [Skipped(i, CONFLICT) for i in broken]
        refused = joint if accepted is None else [i for i in joint if self._name(i) != self._name(accepted)]
        skipped += [Skipped(i, self._why_not(i, accepted)) for i in refused]
        robots = self._robots([i for i in offered if i not in joint], taken, skipped)
        if accepted is not None or (failed and mind.sight is not None):
            mind.joined()  # or will try again
        else:
            mind.passed(None if failed or own is None else now.actions[own].name)
        self._move(taken, robots)
        happens = robots or taken or now.script or believed.script
        self._stuck = best is None and not busy and not happens
        cost = None if before is None else self._ways.price(now, before)
        least = None if best is None else self._ways.price(now, best)
        replanned = best is not None and cost != least
        done = None if failed else accepted
        return SimulatedEpoch(
            number, saw, cost, least, replanned, tuple(plan), done, own, failed, tuple(robots), tuple(skipped)
        )

    def _broken_off(self, his: Sequence[int] = ()) -> list[int]:
        """What can't go on with this epoch, and is given up: first what robots are at.

        Args:
            his: what the person begins, to whom only bystanders don't give way.
        """
        given_up = list[int]()
        while self._later(his) is None:
            script, human = self._now.script, self._now.human
            others = [deed for deed in script.begun(1) if deed.agent not in script.people]
            deeds = others or (() if his else script.begun(1))
            if not deeds:
                break
            worst = max(deeds, key=lambda deed: (deed.agent != human, deed.agent))
            given_up += actions_named(self._now, *self._said(worst.variants[0]))[:1]
            kept = tuple(deed for deed in script.deeds if deed is not worst)
            self._now = replace(
                self._now, script=replace(script, deeds=kept), known_variables=self._now.variables
            )
        return given_up

    def _plan(self, believed: Task) -> HumanPlan | None:
        """What the person means to do, if there is a way as they believe things to be."""
        return None if self._ways.of(believed, self._deadline) is None else self._mind.working(believed)

    def _robots(self, offered: Sequence[int], his: Sequence[int], skipped: list[Skipped]) -> list[int]:
        """What robots begin without the person, who has priority; among them the smaller id."""
        done: list[int] = []
        for action in offered:
            i = self._variant(actions_named(self._now, *self._name(action)))
            if not self._now.actions[i].applicable(self._now.init):
                skipped.append(Skipped(action, INAPPLICABLE))
            elif self._later([*his, *done, i]) is None:
                skipped.append(Skipped(action, CONFLICT))
            else:
                done.append(i)
        return done

    def _why_not(self, action: int, accepted: int | None) -> str:
        """Why a joint action does not take place."""
        i = self._variant(actions_named(self._now, *self._name(action)))
        if not self._now.actions[i].applicable(self._now.init):
            return INAPPLICABLE
        return REFUSED if accepted is None else CONFLICT

    def _move(self, his: Sequence[int], robots: Sequence[int]) -> None:
        expected, later = self._later(his), self._later([*his, *robots])
        assert later is not None, "what is begun was tried before"
        alone = later.init if expected is None else expected.init
        self._saw = tuple((fact, fact in later.init) for fact in sorted(alone ^ later.init))
        self._mind.expects(self._now.actions[i] for i in his)
        self._now = later

    def _later(self, begun: Iterable[int]) -> Task | None:
        """The task after an epoch; None where that is impossible."""
        actions = (self._now.actions[i] for i in begun)
        try:
            return epoch_later(self._now, actions, strict=self._options.strict)
        except BrokenPlanError:
            return None

    def _variant(self, ids: Sequence[int]) -> int:
        return next((i for i in ids if self._now.actions[i].applicable(self._now.init)), ids[0])

    def _name(self, action: int) -> tuple[str, list[str]]:
        return self._said(self._now.actions[action])

    def _said(self, action: GroundAction) -> tuple[str, list[str]]:
        return action.name, [self._now.agents[i] for i in action.participants]

    def _steps(self, joint: Iterable[int]) -> tuple[PlanStep, ...]:
        return named_steps(self._now, self._options.discount, (Step(1, i) for i in joint))
