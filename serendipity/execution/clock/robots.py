"""The robots' policy in time: what they begin in an epoch, while other things go on (semantics 10.6)."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.execution.beliefs import Beliefs
from serendipity.execution.clock.course import Help
from serendipity.execution.clock.explainer import ExplainerInTime
from serendipity.execution.clock.policy import PolicyInTime
from serendipity.execution.clock.supposed import Supposed, is_over, with_actions
from serendipity.execution.decided import Decided, Outlook
from serendipity.execution.guard import RobotActions
from serendipity.execution.history import HelpHistory
from serendipity.execution.prospects import Prospect, best_for_all
from serendipity.execution.why import Why
from serendipity.facade.person.ways import entries_of
from serendipity.model import Deadline, HumanPlan, Options, PlanStep, Task, UsageError
from serendipity.model.errors import LIMITS

_TIME_TO_PLAN: Final = 0.6
"""The share of the time for plans to several goals; the rest is for what they mean with each of them."""


def require_known(task: Task, *, several: bool, noise: object, mode: str) -> None:
    """Return if an execution in time knows all that is asked for.

    Args:
        several: whether there are goals or plans that the person may have.

    Raises:
        UsageError: it does not.
    """
    if several and (task.robot_goal or mode != "serendipity"):
        raise UsageError("goals and plans: in time they go without robots' own goals, and communication")
    if several and noise is not None:
        raise UsageError("noise: in time, which is not known here yet")


class RobotsInTime:
    """Plans anew in each epoch, and leaves alone what the person may need.

    Beside somebody who is told, robots follow the best plan of their mode, or finish the last one; where it
    is not known what they want, a policy.  Somebody else is taken to follow a plan of their own, and to look
    up when they are free.  For them robots do what the best plan says, if it pays with such a person, and
    whatever they begin makes no way dearer that the person may be on, whichever goal is theirs.

    Args:
        beliefs: in goals that the person may have, their explainer one in time; None: they are known to have
            the task's.
        told: the person keeps to the robots' plan.
        surely: whether robots manage whatever is possible.
        habits: for each of these goals, the plan that the person would follow, if known.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        beliefs: Beliefs | None = None,
        *,
        told: bool,
        surely: bool = True,
        habits: Sequence[HumanPlan] = (),
    ) -> None:
        self._task = task
        self._told = told
        self._beliefs = beliefs
        tasks = [task] if beliefs is None else [task.with_goal(one.goal) for one in beliefs.candidates]
        self._supposed = [Supposed(one, options, told=told, surely=surely) for one in tasks]
        for one, habit in zip(self._supposed, habits, strict=False):
            one.theirs.rest, one.theirs.faithful = entries_of(one.task, habit), True
        if beliefs is not None:
            self._explainer.ways = [one.ways for one in self._supposed]
        self._watching = (
            PolicyInTime(task, options, RobotActions(task), told=told, surely=surely)
            if told and beliefs is not None
            else None
        )
        self._history = HelpHistory(task)
        self._gone: frozenset[int] = frozenset()
        self._unable: frozenset[int] = frozenset()
        self._human = task.agents[task.human]

    @property
    def goals(self) -> Mapping[str, float]:
        """The posterior of each candidate goal; empty where there is only one."""
        return {} if self._beliefs is None else self._beliefs.named()

    # -- what robots learn

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """See :class:`serendipity.execution.Robots`."""
        self._history.saw(executed)
        for one in self._supposed:
            one.passed(own, executed, tried)
        if self._beliefs is None:
            return
        self._explainer.passed(own)
        others, habits = None, [i for i, one in enumerate(self._supposed) if one.theirs.faithful]
        if self._watching is not None:
            actions = (self._task.actions[i] for i in (*executed, *(() if tried is None else (tried,))))
            his = next((one.name for one in actions if self._task.human in one.participants), None)
            others = self._watching.saw(his)
        out = [] if others is None else [others]
        if habits:
            pledged = frozenset[int]() if self._watching is None else self._watching.pledged
            strayed = {i for i in habits if self._supposed[i].theirs.rest is None}
            out.append({*strayed, *set(range(len(self._supposed))).difference(habits)} - pledged)
        if any(i != own for i in executed):
            self._beliefs.disturbed()
        if not out:
            self._beliefs.saw(own, executed)
        elif not self._beliefs.rule_out(*out):
            for one in self._supposed:
                one.theirs.faithful = False

    def surprised(self) -> None:
        """See :class:`serendipity.execution.Robots`."""
        self._history.broken("changed")
        self._begin_anew()
        if self._beliefs is not None:
            self._beliefs.disturbed()

    def drop(self, robots: Iterable[int]) -> None:
        """See :class:`serendipity.execution.Robots`."""
        gone = frozenset(robots)
        self._history.broken("out-of-order", ", ".join(self._task.agents[i] for i in sorted(gone)))
        self._gone |= gone
        self._begin_anew()

    def unable(self, actions: Iterable[int]) -> None:
        """See :class:`serendipity.execution.Robots`."""
        self._unable |= frozenset(actions)
        self._begin_anew()

    def _begin_anew(self) -> None:
        for one in self._supposed:
            one.begin_anew()
        if self._watching is not None:
            self._watching.pledge(frozenset(), {})

    # -- what they decide

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """See :class:`serendipity.execution.Robots`."""
        return self._history.told(self._decided(outlook, deadline), outlook.running)

    def _decided(self, outlook: Outlook, deadline: Deadline) -> Decided:
        for one in self._supposed:
            one.looks_up(outlook.world.now)
        now = self._able(outlook.world.now)
        if self._gone.issuperset(self._task.robots):
            gone = tuple(self._task.agents[i] for i in sorted(self._gone))
            return self._idle(outlook, Why("out-of-order", robots=gone))
        if self._beliefs is None:
            return self._with_one(outlook, now, 0, deadline)
        self._explainer.now = outlook.world.now
        weights = self._beliefs.weighed(now.init, deadline)
        known = {goal: self._supposed[goal] for goal in weights}
        if len(known) > 1 or self._watching is not None:
            for one in known.values():
                one.look(now.with_goal(one.task.goal), deadline)
            owes = frozenset[int]() if self._watching is None else self._watching.kept(now)
            known = {goal: one for goal, one in known.items() if one.way is not None or goal in owes}
        if not known or (len(known) == 1 and self._watching is None):
            return self._with_one(outlook, now, next(iter(known or weights)), deadline)
        total = sum(weights[goal] for goal in known)
        shares = {goal: weights[goal] / total for goal in known}
        if self._watching is not None:
            return self._by_policy(outlook, now, self._watching, known, shares, deadline)
        return self._with_several(outlook, known, shares, deadline)

    @property
    def _explainer(self) -> ExplainerInTime:
        """What explains what was seen."""
        assert self._beliefs is not None and isinstance(self._beliefs.explainer, ExplainerInTime)
        return self._beliefs.explainer

    def _able(self, now: Task) -> Task:
        """The task as it stands, without what robots can't do any more."""
        gone, actions = self._gone, now.actions
        kept = [a for i, a in enumerate(actions) if i not in self._unable and gone.isdisjoint(a.participants)]
        return now if len(kept) == len(actions) else with_actions(now, kept)

    def _with_one(self, outlook: Outlook, now: Task, goal: int, deadline: Deadline) -> Decided:
        """The decision where one goal is to be reckoned with."""
        one, busy = self._supposed[goal], bool(self._busy(outlook))
        aimed = now if self._beliefs is None else now.with_goal(one.task.goal)
        found, why, alone = one.help(aimed, deadline, busy=busy)
        if found is None:
            helped = why.kind == "no-help" and self._history.helped and not is_over(aimed, alone)
            decided = self._idle(outlook, replace(why, kind="done") if helped else why)
        else:
            decided = self._following(outlook, one, found, goal)
            if not self._told:
                his = one.expected(aimed, decided.offers, deadline)
                decided = replace(decided, expected=None if his is None else replace(his, epoch=1))
        if self._watching is None or found is None or self._beliefs is None:
            return decided
        return self._watching.for_all(decided, {self._beliefs.candidates[goal].name: found.plan})

    def _with_several(
        self,
        outlook: Outlook,
        known: Mapping[int, Supposed],
        shares: Mapping[int, Fraction],
        deadline: Deadline,
    ) -> Decided:
        """The decision beside somebody who is not told, and may have several goals."""
        part = deadline.sooner(_TIME_TO_PLAN)
        prospects, late = [], False
        for number, (goal, one) in enumerate(known.items()):
            try:
                advice = one.advice(part.part(1 / (len(known) - number)))
            except LIMITS:
                advice, late = None, True
            prospects.append(Prospect(goal, one, advice, shares[goal]))
        best = best_for_all(prospects, deadline)
        if best is None or best.advice is None:
            torn = any(prospect.open for prospect in prospects)
            if torn:
                return self._idle(outlook, Why("unsure", goals=self._guess()))
            kind = "unfound" if late else "done" if self._history.helped else "no-help"
            return self._idle(outlook, Why(kind))
        if any(one.spoilt(best.plan, deadline) for one in known.values()):
            alone = None if best.alone is None else float(best.alone)
            return self._idle(outlook, Why("spoils", float(best.advice.cost), alone))
        found = Help(best.plan, None, best.advice.cost, proved=False, settled=False, pays=True)
        return self._following(outlook, best.hypothesis, found, best.goal)

    def _by_policy(
        self,
        outlook: Outlook,
        now: Task,
        watching: PolicyInTime,
        known: Mapping[int, Supposed],
        shares: Mapping[int, Fraction],
        deadline: Deadline,
    ) -> Decided:
        """The decision beside somebody who is told what the robots' plan has them do for each goal."""
        assert self._beliefs is not None, "there are candidates"
        policy = watching.policy(known, shares, now, deadline)
        prospects = [Prospect(goal, known[goal], one, shares[goal]) for goal, one in policy.items()]
        first = max(prospects, key=lambda one: one.weight * one.saving)
        assert first.advice is not None, "there is a plan for each"
        advice = first.advice
        found = Help(advice.plan, advice.window, advice.cost, advice.proved, settled=False, pays=advice.pays)
        decided = self._following(outlook, first.hypothesis, found, first.goal)
        names = self._beliefs.candidates
        return watching.for_all(decided, {names[one.goal].name: one.plan for one in prospects})

    # -- in words

    def _following(self, outlook: Outlook, one: Supposed, found: Help, goal: int) -> Decided:
        """A decision that follows a plan."""
        first = [replace(step, epoch=outlook.epoch) for step in found.plan if step.epoch == 1]
        own = tuple(step for step in first if self._human not in step.agents)
        offers = tuple(step for step in first if self._human in step.agents and len(step.agents) > 1)
        his = next((step for step in first if self._human in step.agents), None)
        cost, before, robots = float(found.cost), one.alone, self._busy(outlook)
        alone = None if before is None else float(before)
        later = min((s.epoch for s in found.plan if s.agents != (self._human,)), default=None)
        guess = self._guess(goal)
        verdict, why = "helps", Why("pays" if alone is not None else "only-way", cost, alone, goals=guess)
        if not found.pays:
            verdict, why = "works", Why("own-goals")
        if not (own or offers):
            if robots:
                verdict, why = "helps" if found.pays else verdict, Why("goes-on", action=robots[0].action)
            elif later is None and self._told and before is not None and found.cost > before:
                verdict, why = "works", Why("own-goals")  # they ask the person for it
            elif later is None:
                verdict, why = "aside", Why("done" if self._history.helped else "no-help", cost, alone)
            elif self._beliefs is not None and len(self._beliefs.possible()) > 1:
                why = Why("unsure", epoch=outlook.epoch + later - 1, goals=self._guess())
                verdict = "unsure"
            else:
                verdict = "waits" if found.pays else verdict
                why = Why("later", cost, alone, epoch=outlook.epoch + later - 1)
        return Decided(
            outlook.epoch,
            verdict,
            "",
            actions=own,
            offers=offers,
            expected=None if his is None else replace(his, epoch=1),
            plan=found.plan,
            window=found.window,
            cost=cost,
            alone=alone,
            proved=found.proved,
            goals=self.goals,
            because=why,
        )

    def _idle(self, outlook: Outlook, why: Why) -> Decided:
        """No plan: at most something goes on."""
        verdict, robots = "unsure" if why.kind == "unsure" else "aside", self._busy(outlook)
        if robots:
            verdict, why = "helps", Why("goes-on", action=robots[0].action)
        return Decided(outlook.epoch, verdict, "", goals=self.goals, because=why)

    def _busy(self, outlook: Outlook) -> list[PlanStep]:
        """What robots are at."""
        return [step for step in outlook.world.going if self._human not in step.agents]

    def _guess(self, goal: int | None = None) -> tuple[tuple[str, float], ...]:
        """The most probable goals with their probabilities, or one of them; nothing where it is known."""
        return () if self._beliefs is None else self._beliefs.likely(goal)
