"""The likeliest reading of observations that may be wrong, of actions that may be missed (semantics 8)."""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.model import Condition, Deadline, GroundAction, Options, Task
from serendipity.model.answers.recognition import Errors, GoalPosterior, Recognition
from verify.base.beside_script import alone_of
from verify.rules.replay import replay_human

_PARTS: Final = 1 << 20


class NoiseWeights:
    """How much less likely units of cost, wrong observations and missed actions make a reading."""

    def __init__(self, recognised: Recognition) -> None:
        rates, self._observed = recognised.noise or {}, recognised.observed
        miss, wrong = rates.get("miss", 0.0), rates.get("wrong", 0.0)
        less = -math.log(wrong) if wrong else math.inf
        self._logs = recognised.beta, less, -math.log(miss) if miss else 0.0

    def is_likeliest(
        self, task: Task, wanted: Condition, said: GoalPosterior, options: Options, deadline: Deadline
    ) -> bool:
        """Whether a plan with its errors is a reading, and none weighs less; or there is none, as it says."""
        own = self._weighed(task, wanted, deadline)
        least = alone_of(own, deadline, options).optimum(own.init)
        if least is None or said.plan is None or said.errors is None:
            return (least, said.plan, said.errors) == (None, None, None)
        cost = task.cost_of(replay_human(task.with_goal(wanted, Condition()), said.plan, deadline))
        _, wrong, missed = said.errors
        if cost != said.errors.cost or (wrong, missed) not in _errors(said.plan, self._observed):
            return False
        if wrong and math.isinf(self._logs[1]):
            return False
        return least[0] == sum(map(self._weight, range(3), (cost, Fraction(wrong), Fraction(missed))))

    def _weight(self, kind: int, amount: Fraction) -> Fraction:
        return round(self._logs[kind] * _PARTS) * amount if amount else amount

    def _weighed(self, task: Task, wanted: Condition, deadline: Deadline) -> Task:
        """The human alone, whose plans are readings: a counter says how many observations were read."""
        first, last = len(task.facts), len(task.facts) + len(self._observed)
        missed, actions = self._weight(2, Fraction(1)), list[GroundAction]()
        for action in deadline.each(task.actions):
            if action.participants == (task.human,):
                same = replace(action, cost=self._weight(0, action.cost))
                actions.append(replace(same, pre=(*action.pre, last)))
                actions.append(replace(same, neg=(*action.neg, last), cost=same.cost + missed))
                steps = (first + k for k, name in enumerate(self._observed) if name == action.name)
                actions += [_reading(same, at) for at in steps]
        if math.isfinite(self._logs[1]):
            wrong = GroundAction("", (task.human,), (), (), (), (), self._weight(1, Fraction(1)))
            actions += [_reading(wrong, at) for at in range(first, last)]
        return replace(
            task,
            facts=(*task.facts, *(f"read {k}" for k in range(len(self._observed) + 1))),
            init=task.init | {first},
            goal=Condition((*wanted.positive, last), wanted.negative),
            robot_goal=Condition(),
            actions=tuple(actions),
        )

    def log_likelihood(self, errors: Errors | None, costs: Sequence[Fraction | None]) -> float:
        """The logarithm of ``P(O|G)``: of a reading, beside all plans."""
        if errors is None:
            return -math.inf
        weights = [-self._logs[0] * float(cost) for cost in costs if cost is not None]
        beta, wrong, missed = self._logs
        wrongly = wrong * errors.wrong if errors.wrong else 0.0
        said = -beta * float(errors.cost) - missed * errors.missed - wrongly
        return said - max(weights) - math.log(sum(math.exp(weight - max(weights)) for weight in weights))


def _reading(action: GroundAction, at: int) -> GroundAction:
    """An action with which the next observation is read."""
    return replace(action, pre=(*action.pre, at), add=(*action.add, at + 1), delete=(*action.delete, at))


def _errors(plan: Sequence[str], observed: Sequence[str]) -> set[tuple[int, int]]:
    """How many observations may be wrong and actions missed, by all readings of observations in a plan."""
    count = len(observed)
    ways, found = {(0, 0, 0)}, {(count, 0)}  # observations read, wrong ones among them, actions missed
    for name in plan:
        now = {
            (k + 1, wrong + k - read, missed)
            for read, wrong, missed in ways
            for k in range(read, count)
            if observed[k] == name
        }
        found |= {(wrong + count - read, missed) for read, wrong, missed in now}
        ways = now | {(read, wrong, missed + 1) for read, wrong, missed in ways}
    return found
