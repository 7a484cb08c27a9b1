"""The loop, an epoch at a time: robots decide, somebody says what the person does, the world moves on."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, Literal

from serendipity.execution.beliefs import Beliefs
from serendipity.execution.clock.explainer import ExplainerInTime
from serendipity.execution.clock.robots import RobotsInTime, require_known
from serendipity.execution.clock.world import WorldInTime
from serendipity.execution.decided import COLUMNS, Decided, Outlook, Passed, Reported, Robots
from serendipity.execution.leftovers import tidying
from serendipity.execution.robot_policy import RobotPolicy
from serendipity.execution.why import Why
from serendipity.execution.world import Unfinished, World
from serendipity.facade.results import named_steps
from serendipity.model import Deadline, HumanModel, Options, PlanStep, Step, Table, Task, UsageError
from serendipity.model.arguments import BY_NAME, FLAG, TASK_IN_TIME, TEXT, expect, expect_or_none
from serendipity.model.errors import LIMITS
from serendipity.model.keywords import Interference
from serendipity.model.numbers import Number
from serendipity.model.options import limit_of
from serendipity.model.resources.collection import no_collection
from serendipity.model.table import Tabular
from serendipity.model.task.execution import actions_named
from serendipity.model.task.task import canonical_name, several
from serendipity.recognition import CandidateGoal, GoalsGiven, LibraryGiven, Noise, plan_library
from serendipity.recognition.recognise import candidate_goals, strictness
from serendipity.robot import OUTCOMES, Adapter, Epoch, Order, Outcome

_TRIES: Final = 3
"""How often an action of robots may fail before they give it up for good."""

SETUP: Final = 10.0
"""Seconds before the first epoch that tables and a first plan may take, where epochs have a deadline."""

_FIRST_TRY: Final = 2.0
"""Seconds of them in which a plan is looked for at first; twice as many each time that this does not do."""


class Execution(Tabular):
    """A person, robots that may help, and the world; one call for each epoch.

    ``decided`` is what robots are going to do, ``step`` moves on by what the person does::

        run = serendipity.Execution(task, discount=0.6)
        while not run.done:
            run.decided.offers  # what the person may take part in
            run.step("move commx room13 hall8")

    Args:
        task: where things stand; its goal is the person's.
        discount: of robots' costs, in [0, 1].
        human_model: what robots take the person to be: ``observant``, ``local`` or ``omniscient``
            (semantics 6).
        goals: goals that the person may have, as :func:`serendipity.recognise` takes them: robots do not
            know which; None: robots know the task's goal.
        plans: a library of plans that the person may follow, instead of ``goals``; robots take them to be
            omniscient, and ``human_model`` has no effect.
        beta: of the posterior.
        noise: of what robots see of the person, as the posterior takes it, see :func:`serendipity.recognise`.
        deadline: seconds for each decision, or None; robots do nothing in an epoch that has none in time.
        setup: where there is a deadline, seconds before the first epoch for tables and a first plan.
        interference: which actions may share an epoch.
        told: the person knows the robots' plan and keeps to it: they are taken to be omniscient, and robots
            finish what they have begun, or give back what they took.
        mode: ``serendipity``, or ``communication`` with somebody who is told: then robots' plan may also ask
            them to leave their own before they are met.
        leave_free: patterns of the facts that robots may leave otherwise than they would be without them
            (semantics 12); None: all.
        adapter: carries out what robots do; None: whatever is possible is done within the epoch.
        robots: who decides for them, see :class:`serendipity.execution.Robots`; None: the planner.

    Attributes:
        task: where the execution began.
        options: in force.
        goal: the name of the person's goal among ``goals``, or, if they are told, of the most probable of
            ``plans`` to it; None where there is none.
        events: what has happened, as the lines of a log.

    Raises:
        UsageError: an argument is wrong.
        InputError: ``goals`` or ``plans`` are wrong; it says where.
        PlanError: one of ``plans`` is not possible.
    """

    def __init__(
        self,
        task: Task,
        *,
        discount: Number = 0,
        human_model: HumanModel = "observant",
        goals: GoalsGiven | None = None,
        plans: LibraryGiven | None = None,
        beta: Number = 1,
        noise: Noise | str | None = None,
        deadline: float | None = None,
        setup: float = SETUP,
        interference: Interference = "paper",
        told: bool = False,
        mode: Literal["serendipity", "communication"] = "serendipity",
        leave_free: str | None = None,
        adapter: Adapter | None = None,
        robots: Robots | None = None,
    ) -> None:
        expect(TASK_IN_TIME, task=task)
        expect(FLAG, told=told)
        expect(TEXT, mode=mode)
        if mode != "serendipity" and not (told and mode == "communication"):
            expected = "serendipity or communication" if told else "serendipity, where nobody is told"
            raise UsageError(f"mode: expected {expected}, got '{mode}'")
        if plans is not None:
            _require_alone(task, goals, mode)
        if task.needs_time:
            several = goals is not None or plans is not None
            require_known(task, several=several, noise=noise, mode=mode)
        if leave_free is not None:
            if goals is not None or plans is not None:
                raise UsageError("leave_free: goes with a known goal only")
            task = tidying(task, leave_free)
        given: dict[str, Any] = {"discount": discount, "human_model": human_model}
        options = Options(**given, interference=interference)
        if told or plans is not None:
            options = options.but(human_model="omniscient", mode=mode)
        self.task = task
        self.options = options
        self.events: list[dict[str, Any]] = []
        self._deadline = None if deadline is None else limit_of("deadline", deadline, "seconds")
        world = WorldInTime if task.needs_time else World
        self._world = world(task, options.discount, strict=options.strict)
        library = () if plans is None else plan_library(task, plans)
        candidates = [one.aim for one in library] if goals is None else candidate_goals(task, goals)
        for name, asked in (("noise", noise is not None), ("beta", strictness(beta) != 1)):
            if asked and not candidates:
                raise UsageError(f"{name}: goes with goals only")
        habits = [one.plan for one in library]
        policy, explainer = (RobotsInTime, ExplainerInTime) if task.needs_time else (RobotPolicy, None)
        beliefs = Beliefs(task, candidates, beta, noise, explainer) if candidates else None
        if robots is None:
            robots = policy(task, options, beliefs, told=told, surely=adapter is None, habits=habits)
        self._robots = robots
        self.goal = None if library and not told else _name_of(task, candidates)
        self._adapter = adapter
        self._failures: Counter[tuple[tuple[str, ...], str]] = Counter()
        self._reports: tuple[Reported, ...] = ()
        self._running: list[PlanStep] = []
        self._decided: Decided | None = None
        self._passed: list[Passed] = []
        self._paid = self._team = Fraction(0)
        if self._deadline is not None:
            self._prepare(limit_of("setup", setup, "seconds"))

    def __repr__(self) -> str:
        return (
            f"Execution({self.task.name!r:.60}, epoch {self.epoch}, {'done' if self.done else 'under way'})"
        )

    # -- where things stand

    @property
    def human(self) -> str:
        """The person's name."""
        return self.task.agents[self.task.human]

    @property
    def epoch(self) -> int:
        """The epoch that is to come, from 1."""
        return len(self._passed) + 1

    @property
    def state(self) -> frozenset[int]:
        """Ids of the facts that are true."""
        return self._world.state

    @property
    def now(self) -> Task:
        """The task as it stands; in time with the rest of the script, and of what goes on."""
        return self._world.now

    @property
    def going(self) -> tuple[PlanStep, ...]:
        """What has begun and goes on in the epoch that is to come, with the epochs that are left."""
        return self._world.going

    @property
    def facts(self) -> tuple[str, ...]:
        """Names of the facts that are true."""
        return tuple(self.task.facts[fact] for fact in sorted(self._world.state))

    @property
    def done(self) -> bool:
        """Whether the person's goal holds, and they are at nothing."""
        busy = any(self.human in step.agents for step in self._world.going)
        return not busy and self.task.goal.holds(self._world.state)

    @property
    def passed(self) -> tuple[Passed, ...]:
        """The epochs that are over."""
        return tuple(self._passed)

    @property
    def left(self) -> tuple[str, ...]:
        """What robots have not done for goals of their own: facts, ``!`` in front of those to be false."""
        return self.task.robot_goal.open(self._world.state).literals(self.task.facts)

    def table(self) -> Table:
        """The epochs that are over, one a row."""
        return Table(COLUMNS, tuple(passed.cells() for passed in self._passed))

    @property
    def human_cost(self) -> Fraction:
        """What the person has paid, undiscounted."""
        return self._paid

    @property
    def cost(self) -> Fraction:
        """What the team has paid."""
        return self._team

    def possible(self) -> tuple[str, ...]:
        """Names of what the person could do by themselves now."""
        names = (self.task.actions[i].name for i in self.task.human_actions if self._world.applicable(i))
        return tuple(dict.fromkeys(names))

    # -- an epoch

    @property
    def decided(self) -> Decided:
        """What robots are going to do in the epoch that is to come; decided when it is first asked for."""
        if self._decided is None:
            self._decided = self._decide()
        return self._decided

    def recall(self, decided: Decided) -> None:
        """Put another decision in the place of the one that was made, as a record of that epoch has it.

        Raises:
            UsageError: it is of another epoch.
        """
        if self.decided.epoch != decided.epoch:
            raise UsageError(f"recall: expected a decision of epoch {self.epoch}, got one of {decided.epoch}")
        self._decided = decided

    def step(self, action: str | None = None) -> Passed:
        """Move on by one epoch.

        Args:
            action: what the person does: an action of their own, one of ``decided.offers``, or None
                to wait.  What turns out to be impossible does not happen.

        Raises:
            UsageError: there is no such action of theirs, and no such offer.
        """
        expect_or_none(TEXT, action=action)
        decided = self.decided
        name = None if action is None else canonical_name(action)
        offer = next((step for step in decided.offers if step.action == name), None)
        his = None if action is None or offer is not None else self._world.his(action)
        in_vain = his is not None and not self._world.applicable(his)
        tried, his = (his, None) if in_vain else (None, his)
        before = self._world.state
        robots = [*([] if offer is None else [offer]), *decided.actions]
        happened = self._world.play(his, robots, lambda steps: self._carry_out(his, steps))
        self._running = [u.step for u in happened.unfinished if u.why == "running" and u.step is not offer]
        self._learn_from(happened.unfinished)
        paid, team = self._world.cost(happened.executed)
        self._paid, self._team = self._paid + paid, self._team + team
        self._robots.saw(his, happened.executed, tried)
        passed = Passed(
            epoch=decided.epoch,
            decided=decided,
            human=name,
            in_vain=in_vain,
            steps=named_steps(
                self.task, self.options.discount, (Step(decided.epoch, i) for i in happened.executed)
            ),
            unfinished=happened.unfinished,
            reports=self._reports,
            changes=self._world.changes(before),
            human_cost=float(self._paid),
            cost=float(self._team),
            done=self.done,
            going=happened.going,
        )
        self._passed.append(passed)
        self.events.append(passed.to_dict())
        self._decided = None
        return passed

    def change(self, facts: Mapping[str, bool]) -> None:
        """Set facts to true or false, as somebody has seen them.

        Raises:
            UsageError: there is no such fact.
        """
        expect(BY_NAME, facts=facts)
        self._world.change(facts.items())
        self._robots.surprised()
        self.events.append({"change": dict(facts)})
        self._decided = None

    def drop(self, robots: Iterable[str]) -> None:
        """Robots are out of order from now on.

        Raises:
            UsageError: there is no such robot.
        """
        names = [canonical_name(robot) for robot in several(robots, "robots")]
        for name in names:
            if name not in self.task.agents or self.task.agents.index(name) == self.task.human:
                known = ", ".join(self.task.agents[i] for i in self.task.robots)
                raise UsageError(f"robot: expected one of {known}, got '{name}'")
        gone = [self.task.agents.index(name) for name in names]
        self._robots.drop(gone)
        self._world.drop(gone)
        self._running = [step for step in self._running if not set(step.agents).intersection(names)]
        self.events.append({"drop": names})
        self._decided = None

    # -- within an epoch

    def _prepare(self, seconds: float) -> None:
        """What the first decision needs and later ones keep; a plan for it, if there is one by then."""
        share = _FIRST_TRY
        while seconds > 0:
            try:
                self._asked(Deadline(min(share, seconds)))
                return
            except LIMITS:
                seconds, share = seconds - share, 2 * share

    def _decide(self) -> Decided:
        clock = Deadline(self._deadline)
        try:
            decided = self._asked(clock).at(clock.elapsed())
        except LIMITS:
            return self._late(clock.elapsed())
        in_time = self._deadline is None or decided.seconds <= self._deadline
        return decided if in_time else self._late(decided.seconds)

    def _asked(self, clock: Deadline) -> Decided:
        with no_collection():
            return self._robots.decide(Outlook(self.epoch, self._world, tuple(self._running)), clock)

    def _late(self, seconds: float) -> Decided:
        why = Why("late")
        words = why.text(self.human, "late")
        return Decided(self.epoch, "late", words, goals=self._robots.goals, seconds=seconds, because=why)

    def _learn_from(self, unfinished: Sequence[Unfinished]) -> None:
        """What fails again and again is not counted on any more."""
        for missed in unfinished:
            if missed.why == "failed":
                order = missed.step.agents, missed.step.action
                self._failures[order] += 1
                if self._failures[order] == _TRIES:
                    self._robots.unable(actions_named(self.task, missed.step.action, missed.step.agents))

    def _carry_out(self, his: int | None, steps: Sequence[PlanStep]) -> Sequence[Outcome]:
        if self._adapter is None:
            return ["done"] * len(steps)
        human = None if his is None else self.task.actions[his].name
        orders = tuple(map(self._order, steps))
        reports = self._adapter.execute(Epoch(self.epoch, self._world.state, human, orders))
        if len(reports) != len(orders):
            raise UsageError(f"adapter: expected {len(orders)} reports, got {len(reports)}")
        wrong = next((r.outcome for r in reports if r.outcome not in OUTCOMES), None)
        if wrong is not None:
            raise UsageError(f"adapter: expected one of {', '.join(OUTCOMES)}, got {wrong!r:.50}")
        self._reports = tuple(Reported(*pair) for pair in zip(orders, reports, strict=True))
        return [report.outcome for report in reports]

    def _order(self, step: PlanStep) -> Order:
        action = self.task.actions[actions_named(self.task, step.action, step.agents)[0]]
        return Order(step.agents, step.action, action.duration)


def _require_alone(task: Task, goals: GoalsGiven | None, mode: str) -> None:
    """Raise UsageError where a library of plans goes with something else that it knows nothing of."""
    if goals is not None:
        raise UsageError("plans: go without goals, each plan can name its own")
    if task.robot_goal or mode != "serendipity":
        raise UsageError("plans: go without robots' own goals, and without communication")


def _name_of(task: Task, candidates: Sequence[CandidateGoal]) -> str | None:
    """What the most probable candidate is called that is the person's goal; None if none is."""
    theirs = own_goals(task, candidates)
    return max(theirs, key=lambda one: one.prior).name if theirs else None


def own_goals(task: Task, candidates: Iterable[CandidateGoal]) -> list[CandidateGoal]:
    """Those of some candidates that are the task's goal."""
    wanted = set(task.goal.positive), set(task.goal.negative)
    return [c for c in candidates if (set(c.goal.positive), set(c.goal.negative)) == wanted]
