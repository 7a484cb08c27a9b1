"""What is so if a goal is the person's: what they follow then, and the best that robots could do."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.execution.advice import Advice
from serendipity.execution.clock.bystanders import would_pay
from serendipity.execution.clock.course import Course, Help, after_going_on, after_helping
from serendipity.execution.clock.spoiling import Spoiling, begun_of
from serendipity.execution.clock.world import WorldInTime
from serendipity.execution.why import Why
from serendipity.facade.person.follower import Follower
from serendipity.facade.person.played import played_in_time
from serendipity.facade.person.sight import Sight
from serendipity.facade.person.ways import Entries, Way, Ways, begun_in, entries_of
from serendipity.facade.session import Session
from serendipity.model import INFINITE, Condition, Deadline, Options, PlanError, PlanStep, Step, Task
from serendipity.model.answers.simulation import Simulation
from serendipity.model.errors import LIMITS, LimitReachedError, UsageError
from serendipity.model.numbers import as_written, total
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.execution import actions_named, steps_named, variant_named
from serendipity.model.task.passing import at_work

_TIME_TO_PLAN: Final = 0.6
"""The share of the time for plans; the rest is for what they mean for somebody who is not told."""


class Supposed:
    """The person, if a goal is theirs, and what robots had best do for them.

    Where a deadline comes first, methods raise :class:`serendipity.LimitReachedError`.

    Args:
        task: with that goal.
        told: the person keeps to the robots' plan.
        surely: whether robots manage whatever is possible.

    Attributes:
        task: as it stood when the person looked up last.
        theirs: what they mean to do.
        ways: what they could do alone.
        way: what they do alone from there; None where they have no plan.
        session: where plans were asked for last.
    """

    def __init__(self, task: Task, options: Options, *, told: bool, surely: bool) -> None:
        self.task = self._begun = task
        self.ways = Ways(options)
        self.theirs = Follower(self.ways, sight=Sight(task) if options.human_model == "local" else None)
        self.way: Way | None = None
        self.session: Session | None = None
        self._course: Course | None = None
        self._is_sure = False
        """Whether it is proved that no help pays."""
        self._stood = task
        self._options = options
        self._told = told
        self._surely = surely
        self._human = task.agents[task.human]

    def begin_anew(self) -> None:
        """What robots can do, or what is so, has changed."""
        self.session = self._course = None

    def passed(self, own: int | None, executed: Sequence[int], tried: int | None) -> None:
        """Take in an epoch, see :class:`serendipity.execution.Robots`."""
        actions = self._begun.actions
        if any(self._begun.human in actions[i].participants for i in executed if i != own):
            self.theirs.joined()
        else:
            self.theirs.passed(None if own is None else actions[own].name)
        if tried is not None:
            self.theirs.failed(actions[tried], self._stood)
        self.theirs.expects(actions[i] for i in executed if self._begun.human in actions[i].participants)
        if self.session is not None:
            try:
                self.session.execute([actions[i].name for i in executed])
            except UsageError:
                self.session = None  # something did not go on

    def looks_up(self, now: Task) -> None:
        """An epoch is to come, and they see where things stand as far as they do."""
        self._stood = now
        if self.theirs.sight is not None:
            self.theirs.believed(now.with_goal(self.task.goal))

    def help(self, now: Task, deadline: Deadline, *, busy: bool) -> tuple[Help | None, Why, Way | None]:
        """What robots follow from here, or why they follow nothing, and what the person does alone.

        Args:
            now: the task as it stands, with this goal.
            busy: whether robots are at something.
        """
        course, self._course = self._course, None
        if course is not None and (course.state, course.script) != (now.init, now.script):
            course = None
        alone = self.look(now, deadline) if course is None or course.alone is None else course.alone
        self.task, self.way = now, alone
        if is_over(now, alone) and now.robot_goal.holds(now.init):
            return None, Why("no-help"), alone  # everybody has what they want
        if course is None:
            found, why = self.promised(now, alone, deadline)
        elif course.found is None or self._told:
            found, why = course.found, self._none_pays(now, alone)
        else:
            found, why = self._safe(now, course.found, alone, deadline, foreseen=True)
        if found is not None:
            self._course = self._onward(now, found, deadline)
        elif alone is not None and why.kind == "no-help" and not busy:
            self._course = self._onward_alone(now, alone)
        return found, why, alone

    def look(self, now: Task, deadline: Deadline) -> Way | None:
        """What the person does alone from here; if they are free, they look up."""
        self.task = now
        if now.human not in at_work(now):
            self.theirs.look(now, deadline)
        if not self.theirs.knows(now):
            self.way = self._left_alone(deadline)
            return self.way
        self.way = self.ways.of(now, deadline)
        kept = self.theirs.working(now) if self.theirs.faithful else None
        if kept is not None:
            self.way = Way(entries_of(now, kept), now.cost_of(kept))
        return self.way

    @property
    def alone(self) -> Fraction | None:
        """What that costs; None where they have no plan."""
        return None if self.way is None else self.way.cost

    @property
    def meant(self) -> Entries:
        """What they mean to begin from here."""
        kept = self.theirs.working(self.task) if self.theirs.knows(self.task) else None
        if kept is not None:
            return entries_of(self.task, kept)
        return () if self.way is None else self.way.plan

    def played(self, part: Sequence[Step], deadline: Deadline) -> Simulation:
        """What becomes of what robots do, beside this person."""
        now, mind = self.task.with_goal(self.task.goal, Condition()), self.theirs.copy()
        played = played_in_time(now, self._options, (), part, horizon=None, deadline=deadline, mind=mind)
        if played.limit is not None:
            raise LimitReachedError(played.limit)
        return played

    def _left_alone(self, deadline: Deadline) -> Way | None:
        """What becomes of somebody who is wrong about how things stand, if robots begin nothing."""
        played = self.played((), deadline)
        if not played.goals_hold:
            return None
        names = ((step.epoch, self.task.actions[step.action].name) for step in played.steps)
        return Way(tuple(names), played.cost)

    def spoilt(self, plan: Sequence[PlanStep], deadline: Deadline) -> bool:
        """Whether what robots begin now by a plan may spoil something that the person is on the way to."""
        first, now, alone = [step for step in plan if step.epoch == 1], self.task, self.alone
        robots = [step for step in first if self._human not in step.agents]
        offers = [step for step in first if self._human in step.agents and len(step.agents) > 1]
        if alone is None or not (robots or offers):
            return False
        teams = begun_of(robots, surely=self._surely)
        if self.theirs.sight is not None and self._misleads(teams, offers, alone, deadline):
            return True
        guard = Spoiling(now, self.theirs, self.ways, strict=self._options.strict, deadline=deadline)
        begun = [[self._variant(now, step) for step in team] for team in teams if team]
        return bool(robots) and guard.spoils(begun, [self._variant(now, step) for step in offers], alone)

    def advice(self, deadline: Deadline) -> Advice | None:
        """The best plan of the mode with this goal; None where none pays."""
        found = self._best(self.task, self.way, deadline)
        if found is None:
            return None
        return Advice(found.plan, found.window, found.cost, found.pays, found.proved)

    def promised(self, now: Task, alone: Way | None, deadline: Deadline) -> tuple[Help | None, Why]:
        """The best plan that robots may follow; None, and why, where there is none.

        Their own goals they see to without what would spoil something.
        """
        asked = now
        while True:
            found = self._best(asked, alone, deadline.sooner(_TIME_TO_PLAN))
            if found is None or self._told:
                return found, self._none_pays(now, alone)
            safe, why = self._safe(now, found, alone, deadline)
            begun = [step for step in found.plan if step.epoch == 1 and step.agents != (self._human,)]
            if safe is not None or not begun or alone is None or not now.robot_goal:
                return safe if safe is None or asked is now else replace(
                    safe, proved=False, settled=False
                ), why
            left = {asked.actions[i] for i in actions_named(asked, begun[0].action, begun[0].agents)}
            asked = with_actions(asked, [action for action in asked.actions if action not in left])

    def _asked(self, now: Task) -> Session:
        """The session where things stand."""
        session = self.session
        if session is None or _stand(session.task) != _stand(now):
            options = self._options
            session = self.session = Session(
                now,
                mode=options.mode,
                discount=options.discount,
                interference=options.interference,
                window_weight=options.window_weight,
            )
        known = self.theirs.rest
        try:
            working = None if known is None else session.task.plan_from_names(known)
        except PlanError:
            working = None
        session.follow(known if working else None)
        return session

    def _best(self, now: Task, alone: Way | None, deadline: Deadline) -> Help | None:
        """The best plan of the mode that pays or sees to robots' own goals, or the rest of the last one.

        Robots' own goals wait where the person has no plan alone.

        Raises:
            LimitReachedError: the deadline came before it was known.
        """
        works, over = bool(now.robot_goal) and alone is not None, is_over(now, alone)
        if alone is None and now.robot_goal:
            now = now.with_goal(now.goal, Condition())
        if over:
            now = with_actions(
                now, [action for action in now.actions if now.human not in action.participants]
            )
        session = self._asked(now)
        rest = self._rest(session, None if works else alone)
        if rest is not None and would_pay(now, rest.plan, alone, strict=self._options.strict):
            rest = None
        if alone is None or over:
            answer = session.plan(mode="composite", horizon=INFINITE, deadline=deadline)
        elif self.theirs.sight is not None:
            answer = session.plan(human_model="local", deadline=deadline)
        elif works and not self._told:
            answer = session.plan(human_model="observant", deadline=deadline)
        else:
            answer = session.plan(deadline=deadline)
        pays = alone is None or (answer.opportunity and not over)
        harms = would_pay(now, answer.plan or (), alone, strict=self._options.strict)
        if answer.plan is None or harms or not (pays or works):
            if rest is None and answer.status not in ("optimal", "infeasible"):
                raise LimitReachedError("time-limit")
            self._is_sure = answer.status == "optimal" and not harms
            return rest
        cost = total(as_written(step.cost) for step in answer.plan)
        is_best = answer.status == "optimal"
        if rest is not None and rest.cost <= cost:
            return replace(rest, proved=is_best, pays=pays or rest.cost < cost)
        return Help(answer.plan, answer.window, cost, proved=is_best, settled=is_best, pays=pays)

    def _rest(self, session: Session, alone: Way | None) -> Help | None:
        """What is left of the last plan, if robots have a part in it and it still pays."""
        steps = session.rest
        if not steps or all(step.agents == (self._human,) for step in steps):
            return None
        cost = total(as_written(step.cost) for step in steps)
        if alone is not None and cost >= alone.cost:
            return None
        return Help(steps, None, cost, proved=False, settled=False)

    def _none_pays(self, now: Task, alone: Way | None) -> Why:
        if alone is None:
            return Why("out-of-reach")
        if not now.robot_goal.holds(now.init):
            return Why("own-goals-lost")
        return Why("no-help", float(alone.cost), float(alone.cost))

    def _safe(
        self, now: Task, found: Help, alone: Way | None, deadline: Deadline, *, foreseen: bool = False
    ) -> tuple[Help | None, Why]:
        """The plan as it will come out with such a person; None, and why, where it does not pay or spoils.

        Args:
            foreseen: it is known to come out so, if all goes as it was to go with them.
        """
        cost, before = found.cost, None if alone is None else alone.cost
        figures = float(cost), None if before is None else float(before)
        if not (foreseen or (now.robot_goal and before is not None)):  # else it was made for such a person
            will_be = self._outcome(now, found.plan, deadline)
            if will_be is None or (before is not None and will_be >= before):
                return None, Why("untold" if before is not None else "only-told", *figures)
            found = replace(found, cost=will_be, window=None, proved=False)
        if self.spoilt(found.plan, deadline):
            return None, Why("spoils", *figures) if found.pays else Why("own-goals-spoil")
        return found, Why("pays", *figures)

    def _outcome(self, now: Task, plan: Sequence[PlanStep], deadline: Deadline) -> Fraction | None:
        """What the team will pay if robots do their part of a plan, as far as that goes; None: no end."""
        if self.theirs.sight is not None:
            played = self.played(steps_named(now, plan), deadline)
            return played.cost if played.goals_hold else None
        world = WorldInTime(now, self._options.discount, strict=self._options.strict)
        person, spent = self.theirs.copy(), Fraction(0)
        is_news = True  # nobody changes their mind while robots do nothing
        for epoch in range(1, max(step.epoch for step in plan) + 1):
            steps = [step for step in plan if step.epoch == epoch]
            offers = [s for s in steps if self._human in s.agents and len(s.agents) > 1]
            robots = [step for step in steps if self._human not in step.agents]
            busy = world.now.human in at_work(world.now)
            if is_news or offers or person.rest is None:
                choice = person.choose(world.now, offers, deadline)
                is_news = is_news and busy
            else:
                choice = None if busy else person.next
            taken = [choice] if isinstance(choice, PlanStep) else []
            own = world.his(choice) if isinstance(choice, str) else None
            if own is not None and not world.applicable(own):
                own = None
            happened = world.play(own, [*taken, *robots], lambda asked: ["done"] * len(asked))
            if taken:
                person.joined()
            else:
                person.passed(None if own is None else now.actions[own].name)
            spent += world.cost(happened.executed)[1]
            others = any(self._human not in step.agents for step in happened.going)
            is_news = (
                is_news
                or others
                or any(now.actions[i].participants != (now.human,) for i in happened.executed)
            )
        left = self.ways.of(world.now, deadline)
        return None if left is None else spent + left.cost

    def _misleads(
        self,
        teams: Iterable[Sequence[PlanStep]],
        offers: Sequence[PlanStep],
        least: Fraction,
        deadline: Deadline,
    ) -> bool:
        """Whether somebody who may be wrong pays more if what begins now is all that robots ever do."""
        outcomes = (self.played(steps_named(self.task, [*team, *offers]), deadline) for team in teams)
        return any(not played.goals_hold or self._paid(played) > least for played in outcomes)

    def _paid(self, played: Simulation) -> Fraction:
        """What the person pays, undiscounted."""
        actions = (self.task.actions[step.action] for step in played.steps)
        return total(action.cost for action in actions if self.task.human in action.participants)

    def _variant(self, now: Task, step: PlanStep) -> GroundAction:
        return now.actions[variant_named(now, step.action, step.agents, now.init)]

    def _onward_alone(self, now: Task, alone: Way) -> Course | None:
        """What stands after an epoch in which the person goes on with their plan, and no help pays."""
        if not (self._is_sure and self.theirs.knows(now)) or self.theirs.held:
            return None
        name = None if now.human in at_work(now) else self.theirs.next
        return after_going_on(now, self._options, alone, name)

    def _onward(self, now: Task, found: Help, deadline: Deadline) -> Course | None:
        """What stands after an epoch that goes as planned."""
        first = [step for step in found.plan if step.epoch == 1]
        choice: PlanStep | str | None = next((s for s in first if self._human in s.agents), None)
        if not self._told and found.settled:
            offers = [s for s in first if self._human in s.agents and len(s.agents) > 1]
            try:
                choice = self.theirs.copy().choose(now, offers, deadline)
            except LIMITS:
                return None
        return after_helping(now, self._options, found, choice)

    def expected(self, now: Task, offers: Sequence[PlanStep], deadline: Deadline) -> PlanStep | None:
        """What the person is going to begin, as robots take them to be."""
        choice = self.theirs.copy().choose(now, offers, deadline)
        if not isinstance(choice, str):
            return choice
        action = now.actions[actions_named(now, choice, [self._human])[0]]
        return PlanStep(1, (self._human,), choice, float(action.cost), action.duration)


def is_over(now: Task, alone: Way | None) -> bool:
    """Whether the person has what they want, or it comes by itself."""
    return alone is not None and not begun_in(alone.plan) and now.human not in at_work(now)


def with_actions(now: Task, actions: Iterable[GroundAction]) -> Task:
    """The task as it stands, with these of its actions only."""
    return replace(now, actions=tuple(actions), known_variables=now.variables)


def _stand(task: Task) -> tuple[object, ...]:
    """What tells where things stand, and what can be done and is wanted."""
    return task.init, task.script, task.robot_goal, task.actions
