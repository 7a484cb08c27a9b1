"""Advice for several goals at once: robots watch, and act by what they have seen (semantics 11).

What was advised is pledged for each of the goals.  Robots go on with it as long as the person does their
part for a goal that is still possible, unless something is found that costs less in the mean and asks
nobody to pay more than was pledged.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.execution.advice import Advice, DecisionPoint
from serendipity.execution.decided import Decided
from serendipity.execution.guard import RobotActions
from serendipity.execution.hypotheses import Hypothesis
from serendipity.execution.session_adviser import Pledge, RestrictedSessions
from serendipity.facade.results import named_steps
from serendipity.model import Deadline, Options, PlanStep, Step, Task
from serendipity.model.errors import LIMITS, LimitReachedError
from serendipity.model.numbers import as_written, total
from serendipity.model.task.actions import Condition
from serendipity.model.task.execution import actions_of, steps_named, variant_named

_BETTER: Final = 0.5
"""The share of the time for what is better than the rest of a policy."""

Known = Mapping[int, Hypothesis]
"""What is so if a goal is the person's, by goal."""

Policy = dict[int, Advice]
"""What everybody does, by goal; robots do the same for all of them until the person does not."""


class PolicyAdviser:
    """Plans for all goals that are possible, for a person who is told or taken to be omniscient.

    Args:
        actions: what robots can do.
        told: the person keeps to the robots' plan: nothing has to be left alone.
        surely: whether robots manage whatever is possible.
    """

    def __init__(
        self, task: Task, options: Options, actions: RobotActions, *, told: bool, surely: bool
    ) -> None:
        self._task = task
        self._options = options
        self._discount = options.discount
        self._actions = actions
        self._told = told
        self._surely = surely
        self._sessions = RestrictedSessions(
            task,
            discount=options.discount,
            interference=options.interference,
            mode=options.mode,
            human_model=options.human_model,
            window_weight=options.window_weight,
        )
        self._pledges: dict[int, Pledge] = {}

    @property
    def pledged(self) -> frozenset[int]:
        """The goals for which a plan was pledged, and the person has done their part so far."""
        return frozenset(self._pledges)

    def owes(self, goal: int) -> bool:
        """Whether a plan for a goal was pledged, and the person has done their part so far."""
        return self._told and goal in self._pledges

    def saw(self, his: str | None) -> set[int] | None:
        """Take in what the person did; the goals for which the plan has them do something else.

        None where no plan was pledged.
        """
        if not self._pledges:
            return None
        human, others = self._task.agents[self._task.human], set()
        for goal, pledge in self._pledges.items():
            step = next((step for step in pledge.now if human in step.agents), None)
            joint = step is not None and len(step.agents) > 1
            missed = his is None and joint and not self._surely  # it may be the robots' fault
            if not missed and his != (None if step is None else step.action):
                others.add(goal)
        self._pledges = {goal: known for goal, known in self._pledges.items() if goal not in others}
        return others

    def advise(
        self,
        known: Known,
        able: Collection[int],
        weights: Mapping[int, Fraction],
        now: DecisionPoint,
        deadline: Deadline,
    ) -> Policy:
        """The best policy that is found in time; empty where the person has no plan alone, and none pledged.

        Args:
            known: of the goals that are possible.
            able: those that the person is known to reach alone; other than these are not planned for anew.
            weights: how probable they are.
            now: where things stand.

        Raises:
            LimitReachedError: the deadline came before there was any.
        """
        needed = (self._actions.spoiling(one.following.needed()) for one in known.values())
        careful = now.barred.union(*needed)
        removed = now.barred if self._told else careful
        while True:
            best = self._best(known, able, weights, now, (removed, removed | careful), deadline)
            first = (step for one in best.values() for step in one.plan if step.epoch == 1)
            chosen = (variant_named(self._task, step.action, step.agents, now.state) for step in first)
            robots = [i for i in chosen if self._task.actions[i].participants != (self._task.human,)]
            if now.allows(robots):
                break
            removed |= {robots[0]}
        self.pledge(now.state, best)
        return best

    def pledge(self, state: frozenset[int], policy: Policy) -> None:
        """Say what everybody is going to do from a state, by goal."""
        self._pledges = {goal: Pledge.of(self._task, state, one) for goal, one in policy.items()}

    def for_all(self, decided: Decided, policy: Mapping[str, Sequence[PlanStep]]) -> Decided:
        """A decision with what is to be done with the person, and by them, whichever goal is theirs.

        Args:
            policy: what everybody does, by the goal's name.
        """
        human = self._task.agents[self._task.human]
        his = {
            name: next((step for step in plan if step.epoch == 1 and human in step.agents), None)
            for name, plan in policy.items()
        }
        offers = (replace(s, epoch=decided.epoch) for s in his.values() if s and len(s.agents) > 1)
        wishes = {name: None if step is None else step.action for name, step in his.items()}
        return replace(decided, offers=tuple(dict.fromkeys(offers)), wishes=wishes if self._told else {})

    def _best(
        self,
        known: Known,
        reachable: Collection[int],
        weights: Mapping[int, Fraction],
        now: DecisionPoint,
        removed: tuple[frozenset[int], frozenset[int]],
        deadline: Deadline,
    ) -> Policy:
        """What is cheapest in the mean of what was pledged and what is found now."""
        rest = self._rest(known, replace(now, out=now.out | (removed[0] - now.barred), barred=removed[0]))
        able = {goal: one for goal, one in known.items() if goal in reachable}
        if rest and (len(able) < len(known) or (self._told and all(one.proved for one in rest.values()))):
            return rest
        most = {goal: self._paid(rest[goal]) if rest else one.following.alone for goal, one in able.items()}
        deadline = deadline.part(_BETTER) if rest else deadline
        for without in dict.fromkeys(removed):
            try:
                found = self._asked(able, weights, now.state, without, deadline)
            except LIMITS:
                if rest or without != removed[0]:
                    break
                raise
            if all(self._paid(one) <= (most[goal] or 0) for goal, one in found.items()):
                costs = [sum(weights[goal] * of[goal].cost for goal in of) for of in (found, rest)]
                idle = not any(one.pays for one in found.values())
                return found if not rest or costs[0] < costs[1] + (costs[0] == costs[1] and idle) else rest
        return rest or {goal: self._idle(one) for goal, one in able.items()}

    def _rest(self, known: Known, now: DecisionPoint) -> Policy:
        """What was pledged, where it still leads to all of the goals; else nothing."""
        found = {}
        for goal, one in known.items():
            pledge = self._pledges.get(goal)
            rest = None if pledge is None else pledge.rest(one.task, now, mend=self._told, hopeless=False)
            if rest is None:
                return {}
            found[goal] = rest
        return found

    def _asked(
        self,
        known: Known,
        weights: Mapping[int, Fraction],
        state: frozenset[int],
        removed: frozenset[int],
        deadline: Deadline,
    ) -> Policy:
        promises = {goal: one.following.promise() for goal, one in known.items()}
        if not any(promises.values()):
            return {goal: self._idle(one) for goal, one in known.items()}
        plans = [
            {
                "name": str(goal),
                "probability": weights[goal],
                "goal": self._literals(one.task.goal),
                "plan": [self._task.actions[i].name for i in promises[goal]],
            }
            for goal, one in known.items()
        ]
        session = self._sessions.at(state, removed)
        session.follow(None)  # the last question may have been about a single plan
        result = session.plan(plans=plans, deadline=deadline)
        if result.status == "unknown":
            raise LimitReachedError("time-limit")
        found, proved = {}, result.status == "optimal"
        told = [(one.plan, one.window) for one in result.goals or ()] or [(result.plan, result.window)]
        for goal, (plan, window) in zip(known, told, strict=True):
            assert plan is not None, "beside idle robots the person does as planned"
            cost = total(as_written(step.cost) for step in plan)
            found[goal] = Advice(plan, window, cost, result.opportunity, proved)
        return found

    def _idle(self, one: Hypothesis) -> Advice:
        """Robots do nothing."""
        steps = [Step(epoch, i) for epoch, i in enumerate(one.following.promise(), start=1)]
        plan = named_steps(self._task, self._discount, steps)
        return Advice(plan, None, one.following.alone or Fraction(0), pays=False, proved=False)

    def _paid(self, advice: Advice) -> Fraction:
        """What the person pays."""
        steps = steps_named(self._task, advice.plan)
        his = (a for a in actions_of(self._task, steps) if self._task.human in a.participants)
        return total(action.cost for action in his)

    def _literals(self, goal: Condition) -> list[str]:
        facts = self._task.facts
        return [*(facts[i] for i in goal.positive), *(f"!{facts[i]}" for i in goal.negative)]
