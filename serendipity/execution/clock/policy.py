"""Policies in time: what robots do beside somebody who is told, whichever goal is theirs (semantics 11)."""

from collections.abc import Mapping
from fractions import Fraction

from serendipity.execution.advice import Advice
from serendipity.execution.clock.course import after
from serendipity.execution.clock.supposed import Supposed
from serendipity.execution.policy_adviser import Policy, PolicyAdviser
from serendipity.execution.session_adviser import Pledge, moved
from serendipity.facade.person.ways import begun_in
from serendipity.facade.results import named_steps
from serendipity.facade.session import Session
from serendipity.model import Deadline, PlanError, Step, Task, UsageError
from serendipity.model.errors import LimitReachedError
from serendipity.model.numbers import as_written, total


class PolicyInTime(PolicyAdviser):
    """What was advised is pledged, and followed while all goes as planned; it asks nobody to pay for it."""

    def policy(
        self, known: Mapping[int, Supposed], weights: Mapping[int, Fraction], now: Task, deadline: Deadline
    ) -> Policy:
        """The best policy that is found in time.

        Args:
            known: of the goals that are possible, the person having a plan alone, or a pledge being kept.
            weights: how probable they are.
            now: the task as it stands.

        Raises:
            LimitReachedError: the deadline came before there was any.
        """
        if kept := self.kept(now):
            policy = {
                goal: self._pledges[goal].later if goal in kept else self._alone(one)
                for goal, one in known.items()
            }
        else:
            policy = self._asked_in_time(known, weights, now, deadline)
        self._pledges = {goal: self._pledge(now, one) for goal, one in policy.items()}
        return policy

    def kept(self, now: Task) -> frozenset[int]:
        """The goals for which all has gone as it was pledged."""
        return frozenset(goal for goal, one in self._pledges.items() if one.stands(now))

    def _asked_in_time(
        self, known: Mapping[int, Supposed], weights: Mapping[int, Fraction], now: Task, deadline: Deadline
    ) -> Policy:
        share = sum(weights[goal] for goal in known)
        plans = [
            {
                "name": str(goal),
                "probability": weights[goal] / share,
                "goal": self._literals(one.task.goal),
                "plan": one.meant,
            }
            for goal, one in known.items()
        ]
        options = self._options
        session = Session(now, discount=options.discount, interference=options.interference)
        try:
            result = session.plan(plans=plans, nobody_pays=True, deadline=deadline)
        except (PlanError, UsageError):  # the script ends a goal before another one is reached
            return {goal: self._alone(one) for goal, one in known.items()}
        if result.status == "unknown":
            raise LimitReachedError("time-limit")
        told = [(one.plan, one.window) for one in result.goals or ()] or [(result.plan, result.window)]
        found = {}
        for goal, (plan, window) in zip(known, told, strict=True):
            if plan is None:
                return {goal: self._alone(one) for goal, one in known.items()}
            cost = total(as_written(step.cost) for step in plan)
            found[goal] = Advice(plan, window, cost, result.opportunity, result.status == "optimal")
        return found

    def _alone(self, one: Supposed) -> Advice:
        """Robots do nothing."""
        steps = [Step(epoch, one.task.named[name][0]) for epoch, name in begun_in(one.meant)]
        plan = named_steps(one.task, self._discount, steps)
        return Advice(plan, None, one.alone or Fraction(0), pays=False, proved=False)

    def _pledge(self, now: Task, advice: Advice) -> Pledge:
        """What an advice makes of the epoch that is to come."""
        first = tuple(step for step in advice.plan if step.epoch == 1)
        his = next((step for step in first if now.agents[now.human] in step.agents), None)
        rest = tuple(moved(step for step in advice.plan if step.epoch > 1))
        world = after(now, self._options, advice.plan, his)
        spent = total(as_written(step.cost) for step in first)
        later = Advice(rest, None, advice.cost - spent, advice.pays, advice.proved)
        if world is None:  # it is made anew
            return Pledge(now.init, first, frozenset(), later, None)
        return Pledge(now.init, first, world.state, later, world.now.script)
