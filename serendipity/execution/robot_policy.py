"""The robots' policy: what they know of the person, and what they decide in each epoch."""

from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.execution.advice import DecisionPoint
from serendipity.execution.beliefs import Beliefs
from serendipity.execution.decided import Decided, Outlook
from serendipity.execution.history import HelpHistory, Untouched
from serendipity.execution.hypotheses import Hypotheses, Hypothesis
from serendipity.execution.policy_adviser import PolicyAdviser
from serendipity.execution.prospects import Prospect, best_for_all
from serendipity.execution.why import Why
from serendipity.model import Deadline, HumanPlan, Options, PlanStep, Task
from serendipity.model.errors import LIMITS, LimitReachedError

_Prospect = Prospect[Hypothesis]

_TIME_TO_TELL: Final = 0.5
"""The share of the time that has to be left for finding out why nothing is done."""

_TELLING: Final = 1.0
"""The most seconds that this may take."""

_TIME_TO_WEIGH: Final = 0.4
"""The share of the time that is kept for what comes after planning."""

_TIME_TO_LOOK: Final = 0.4
"""The share of the time for what the person could do alone, where robots have pledged something."""


class RobotPolicy:
    """Recognises, plans, and leaves alone what the person may need.

    Args:
        beliefs: in goals that the person may have; None: they are known to have the task's.
        told: the person keeps to the robots' plan.
        surely: whether robots manage whatever is possible.
        habits: for each of these goals, the plan that the person would follow, if known.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        beliefs: Beliefs | None,
        *,
        told: bool,
        surely: bool = True,
        habits: Sequence[HumanPlan] = (),
    ) -> None:
        self._task = task
        self._told = told
        self._gone: dict[int, frozenset[int]] = {}
        self._failing: frozenset[int] = frozenset()
        self._beliefs = beliefs
        tasks = [task] if beliefs is None else [task.with_goal(one.goal) for one in beliefs.candidates]
        self._hypotheses = Hypotheses(tasks, options, told=told, surely=surely, habits=habits)
        sessions = options.human_model == "omniscient" and options.mode == "serendipity"
        self._watching = (
            PolicyAdviser(task, options, self._hypotheses.actions, told=told, surely=surely)
            if sessions and beliefs is not None and not task.robot_goal
            else None
        )
        self._history = HelpHistory(task)
        self._untouched = Untouched(task)
        self._human = task.agents[task.human]
        self._agents = {name: i for i, name in enumerate(task.agents)}

    @property
    def goals(self) -> dict[str, float]:
        """The posterior of each candidate goal; empty where there is only one."""
        return {} if self._beliefs is None else self._beliefs.named()

    def again(self) -> "RobotPolicy":
        """The same robots, who know what these know, and go their own way from here; their goal is known."""
        assert self._beliefs is None, "what is known of several goals is not told twice"
        other = copy(self)
        other._hypotheses = self._hypotheses.again()
        other._history = HelpHistory(self._task)
        other._untouched = Untouched(self._task)
        return other

    # -- what robots learn

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """See :class:`serendipity.execution.Robots`."""
        self._history.saw(executed)
        self._untouched.saw(own, executed)
        self._hypotheses.acted(own, executed, tried)
        if self._beliefs is None:
            return
        his, habits = self._done_by_them(executed, tried), self._hypotheses.habits
        others = None if self._watching is None else self._watching.saw(his)
        out = [others] if self._told and others is not None else []
        if habits and self._watching is not None:
            out.append(self._hypotheses.go_on(his, in_vain=tried is not None) - self._watching.pledged)
        if not out:
            self._beliefs.saw(own, executed)
        elif not self._beliefs.rule_out(*out):
            self._hypotheses.habits = {}

    def _done_by_them(self, executed: Sequence[int], tried: int | None) -> str | None:
        actions = (self._task.actions[i] for i in (*executed, *(() if tried is None else (tried,))))
        return next((action.name for action in actions if self._task.human in action.participants), None)

    def surprised(self) -> None:
        """The world is other than what actions have made it."""
        self._history.broken("changed")
        self._untouched.forget()
        self._hypotheses.surprised()
        if self._watching is not None:
            self._watching.pledge(frozenset(), {})
        if self._beliefs is not None:
            self._beliefs.disturbed()

    def drop(self, robots: Iterable[int]) -> None:
        """Robots are out of order: nothing that they take part in is possible any more."""
        gone = tuple(robots)
        self._history.broken("out-of-order", ", ".join(self._task.agents[i] for i in gone))
        self._gone = self._gone | {robot: self._hypotheses.actions.of([robot]) for robot in gone}

    def unable(self, actions: Iterable[int]) -> None:
        """See :class:`serendipity.execution.Robots`."""
        self._failing |= frozenset(actions)

    # -- what they decide

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """What robots do in the epoch that is to come.

        Raises:
            LimitReachedError: the deadline came first; robots had better do nothing.
        """
        return self._history.told(self._decided(outlook, deadline), outlook.running)

    def _decided(self, outlook: Outlook, deadline: Deadline) -> Decided:
        state, able = outlook.world.state, self._hypotheses.actions
        self._untouched.look(state)
        weights = {0: Fraction(1)} if self._beliefs is None else self._beliefs.weighed(state, deadline)
        owes = self._watching.owes if self._watching is not None else lambda _: False
        share = deadline.part(_TIME_TO_LOOK) if (pledged := all(map(owes, weights))) else deadline
        reachable, in_time = self._hypotheses.reachable(state, weights, share, must=not pledged)
        goals = [goal for goal in weights if goal in reachable or owes(goal)] or list(weights)[:1]
        gone = frozenset[int]().union(*self._gone.values())
        out = gone | self._failing
        if able.all <= gone or (reachable and able.all <= out):
            return self._idle(outlook, self._disabled(state, reachable))
        running = self._going_on(outlook, goals)
        barred = out | able.of(self._agents[name] for step in outlook.running for name in step.agents)
        if able.all <= barred and running and not self._told:
            return self._idle(outlook, Why("out-of-order"), running)
        begun = frozenset(map(outlook.world.of, running))
        now = DecisionPoint(state, out, barred, begun, self._hypotheses.allows(goals, list(begun)))
        likely = {goal: weights[goal] for goal in goals}
        if watched := self._watched(likely, reachable, now, deadline):
            return self._chosen(outlook, now, watched, running, deadline, watched=True)
        if not in_time:
            raise LimitReachedError("time-limit")
        prospects = self._planned(likely, now, deadline.sooner(_TIME_TO_WEIGH))
        if not reachable and prospects[0].advice is None and not running and self._failing - gone:
            prospects = self._planned(likely, replace(now, out=gone, barred=gone), deadline)
        return self._chosen(outlook, now, prospects, running, deadline)

    def _chosen(
        self,
        outlook: Outlook,
        now: DecisionPoint,
        prospects: Sequence[_Prospect],
        running: Sequence[PlanStep],
        deadline: Deadline,
        *,
        watched: bool = False,
    ) -> Decided:
        """The decision, once it is known what is best for each goal, or, if ``watched``, for all of them."""
        certain = len(prospects) == 1
        if certain and prospects[0].advice is None:
            return self._idle(outlook, self._lost(now, prospects[0].hypothesis, deadline), running)
        if watched:
            prospect: _Prospect | None = max(prospects, key=lambda one: one.weight * one.saving)
        else:
            prospect = prospects[0] if certain else best_for_all(prospects, deadline)
        if prospect is not None:
            decided = self._following(outlook, prospect, running)
            if watched and self._watching is not None:
                decided = self._watching.for_all(decided, self._named(prospects))
            elif self._told and self._watching is not None and prospect.advice is not None:
                self._watching.pledge(now.state, {prospect.goal: prospect.advice})
                decided = self._watching.for_all(decided, self._named([prospect]))
            if decided.verdict != "aside":
                return decided
        elif running:
            return self._idle(outlook, Why("no-help"), running)
        elif self._torn(now, prospects, deadline):
            return self._idle(outlook, Why("unsure", goals=self._guess()))
        else:
            done = next((prospect for prospect in prospects if prospect.pays and not prospect.open), None)
            decided = self._following(outlook, done, ()) if done else self._idle(outlook, Why("no-help"))
        made_up = None if self._told and self._watching else self._made_up(outlook, now, prospects, deadline)
        return made_up or replace(decided, because=self._why_not(now, decided, prospects, deadline))

    def _made_up(
        self, outlook: Outlook, now: DecisionPoint, prospects: Sequence[_Prospect], deadline: Deadline
    ) -> Decided | None:
        """Robots make up for what they have done, if somebody pays more for it and there is a way."""
        for prospect in prospects:
            if owed := self._owed(now.state, prospect.hypothesis):
                try:
                    advice = prospect.hypothesis.amends(now, deadline.part(_TIME_TO_TELL))
                except LIMITS:
                    continue
                if advice is not None:
                    return self._following(outlook, replace(prospect, advice=advice), (), owed)
        return None

    def _owed(self, state: frozenset[int], *hypotheses: Hypothesis) -> float:
        """How much dearer the person's way is by what robots have done, at most."""
        return float(max(known.owed(self._untouched.state, state) for known in hypotheses))

    def _going_on(self, outlook: Outlook, goals: Sequence[int]) -> list[PlanStep]:
        """What was begun and may still be finished."""
        running: list[PlanStep] = []
        allows = self._hypotheses.allows(goals)
        for step in outlook.running:
            if allows([outlook.world.of(other) for other in (*running, step)]):
                running.append(step)
        return running

    def _watched(
        self,
        weights: dict[int, Fraction],
        reachable: Sequence[int],
        now: DecisionPoint,
        deadline: Deadline,
    ) -> list[_Prospect]:
        """A prospect for each goal, of a policy for all of them; nothing where none is looked for."""
        if self._watching is None:
            return []
        total = sum(weights.values())
        shares = {goal: weight / total for goal, weight in weights.items()}
        known = {goal: self._hypotheses[goal] for goal in weights}
        policy = self._watching.advise(known, reachable, shares, now, deadline.sooner(_TIME_TO_WEIGH))
        for one in known.values():
            one.companion.under(deadline)
        return [Prospect(goal, known[goal], advice, shares[goal]) for goal, advice in policy.items()]

    def _named(self, prospects: Iterable[_Prospect]) -> dict[str, Sequence[PlanStep]]:
        """What everybody does, by the name of the goal."""
        assert self._beliefs is not None, "there are candidates"
        return {self._beliefs.candidates[one.goal].name: one.plan for one in prospects}

    def _planned(
        self, weights: dict[int, Fraction], now: DecisionPoint, deadline: Deadline
    ) -> list[_Prospect]:
        """A prospect for each goal; goals that hardly matter get what time is left."""
        total = sum(weights.values())
        prospects = []
        for number, (goal, weight) in enumerate(weights.items()):
            known = self._hypotheses[goal]
            try:
                share = deadline.part(1 / (len(weights) - number))
                advice = known.adviser.advise(known.following, now, share)
            except LIMITS:
                if len(weights) == 1:
                    raise
                advice = None
            known.companion.under(deadline)
            prospects.append(Prospect(goal, known, advice, weight / total))
        return prospects

    def _torn(self, now: DecisionPoint, prospects: Sequence[_Prospect], deadline: Deadline) -> bool:
        """Whether help would pay if it were known which goal it is; taken for no if time does not tell."""
        if len(prospects) < 2 or any(prospect.open for prospect in prospects):
            return len(prospects) > 1
        if not _leisurely(deadline):
            return False
        try:
            for prospect in prospects:
                alone = replace(now, allows=self._hypotheses.allows([prospect.goal]))
                known = prospect.hypothesis
                advice = known.adviser.advise(known.following, alone, deadline)
                if advice is not None and advice.pays:
                    return True
        except LIMITS:
            pass
        return False

    def _why_not(
        self, now: DecisionPoint, decided: Decided, prospects: Sequence[_Prospect], deadline: Deadline
    ) -> Why:
        """Why nothing is done, whatever the goal is, and what the person pays more by what was done."""
        owed = self._owed(now.state, *(prospect.hypothesis for prospect in prospects))
        why = decided.because
        if why is None or why.kind != "done":
            why = self._no_help(now, prospects, deadline)
        return replace(why, owed=owed)

    def _no_help(self, now: DecisionPoint, prospects: Sequence[_Prospect], deadline: Deadline) -> Why:
        """In which sense no help pays."""
        if not all(prospect.advice is not None and prospect.advice.proved for prospect in prospects):
            return Why("unfound")
        if self._told:
            return Why("no-help")
        if not _leisurely(deadline):
            return Why("no-safe-help")
        share = deadline.part(_TIME_TO_TELL).within(_TELLING)
        try:
            whys = [p.hypothesis.unbound.why(p.hypothesis.following, now, share) for p in prospects]
        except LIMITS:
            return Why("no-safe-help")
        return next((why for why in whys if why.kind != "no-help"), whys[0])

    def _lost(self, now: DecisionPoint, known: Hypothesis, deadline: Deadline) -> Why:
        """Why there is no plan at all."""
        share = deadline.part(_TIME_TO_TELL).within(_TELLING)
        try:
            if not known.following.hopeless:
                return known.unbound.why_not_even_alone(known.following, now, share)
            return Why("out-of-reach") if self._told else known.unbound.why_out_of_reach(now, share)
        except LIMITS:
            return Why("unfound")

    def _disabled(self, state: frozenset[int], goals: Sequence[int]) -> Why:
        """Nobody is left who could do anything."""
        if not goals:
            return Why("out-of-reach")
        owed = self._owed(state, *(self._hypotheses[goal] for goal in goals))
        gone = tuple(self._task.agents[i] for i in sorted(self._gone))
        if len(gone) < len(self._task.robots):
            return Why("all-failed", owed=owed)
        return Why("out-of-order", robots=gone, owed=owed)

    def _following(
        self, outlook: Outlook, prospect: _Prospect, running: Sequence[PlanStep], owed: float = 0.0
    ) -> Decided:
        """A decision that follows a plan, even if that is to do nothing."""
        now = [PlanStep(outlook.epoch, s.agents, s.action, s.cost) for s in prospect.plan if s.epoch == 1]
        his = next((step for step in now if self._human in step.agents), None)
        begun = {(step.agents, step.action) for step in running}
        own = [s for s in now if self._human not in s.agents and (s.agents, s.action) not in begun]
        offers = tuple(step for step in now if self._human in step.agents and len(step.agents) > 1)
        verdict, why = self._meant(outlook.epoch, prospect, running, [*own, *offers])
        cost, alone = prospect.figures
        if owed:
            why = replace(why, kind="owed" if why.kind == "pays" else why.kind, owed=owed)
        return Decided(
            outlook.epoch,
            verdict,
            "",
            actions=(*running, *own),
            offers=offers,
            expected=None if his is None else replace(his, epoch=1),
            plan=prospect.plan,
            window=None if prospect.advice is None else prospect.advice.window,
            cost=cost,
            alone=alone,
            proved=prospect.advice is not None and prospect.advice.proved,
            goals=self.goals,
            because=why,
        )

    def _meant(
        self, epoch: int, prospect: _Prospect, running: Sequence[PlanStep], new: Sequence[PlanStep]
    ) -> tuple[str, Why]:
        """Verdict and reason of a decision that follows a plan; if nothing is done, others know why."""
        if running and not new and (self._task.robot_goal or not prospect.pays):
            return "helps", Why("goes-on", action=running[0].action)
        if not prospect.pays:
            return ("works", Why("own-goals")) if new else ("aside", Why("no-help"))
        if running or new:
            kind = "only-way" if prospect.alone is None else "pays"
            return "helps", Why(kind, *prospect.figures, goals=self._guess(prospect.goal))
        later = min((s.epoch for s in prospect.plan if s.agents != (self._human,)), default=None)
        if later is None:
            if self._told and prospect.saving < 0:  # they ask the person for it
                return "works", Why("own-goals")
            return "aside", Why("done", *prospect.figures) if self._history.helped else Why("no-help")
        if self._beliefs is not None and len(self._beliefs.possible()) > 1:
            return "unsure", Why("unsure", epoch=epoch + later - 1, goals=self._guess())
        return "waits", Why("later", *prospect.figures, epoch=epoch + later - 1)

    def _idle(self, outlook: Outlook, why: Why, running: Sequence[PlanStep] = ()) -> Decided:
        """No plan: at most something that was begun is finished."""
        verdict = "unsure" if why.kind == "unsure" else "aside"
        if running:
            verdict, why = "helps", Why("goes-on", action=running[0].action)
        return Decided(outlook.epoch, verdict, "", actions=tuple(running), goals=self.goals, because=why)

    def _guess(self, goal: int | None = None) -> tuple[tuple[str, float], ...]:
        """The most probable goals with their probabilities, or one of them; nothing where it is known."""
        return () if self._beliefs is None else self._beliefs.likely(goal)


def _leisurely(deadline: Deadline) -> bool:
    """Whether there is time for finding out why nothing is done."""
    left = deadline.left()
    return left is None or left >= _TIME_TO_TELL * (left + deadline.elapsed())
