"""The human's own actions as the checker's own search sees them."""

from fractions import Fraction
from math import lcm
from typing import NamedTuple

from serendipity.model import Condition, GroundAction, Task


class Operator(NamedTuple):
    """An own action reduced to the facts that can matter for the goal.

    ``weight`` orders plans by (cost, length): see :class:`Weights`.
    """

    pre: frozenset[int]
    neg: frozenset[int]
    add: frozenset[int]
    delete: frozenset[int]
    weight: int


class Weights:
    """Integers that order plans by cost, then by number of actions.

    A cost of 1 weighs ``unit`` and an action 1 more; ``unit`` exceeds the length of
    any plan that is ever compared.
    """

    _LONGEST = 10**9

    def __init__(self, actions: list[GroundAction]) -> None:
        self.unit = lcm(*(action.cost.denominator for action in actions)) * self._LONGEST

    def of(self, cost: Fraction, length: int) -> int:
        """The weight of a plan."""
        return int(cost * self.unit) + length

    def split(self, weight: int) -> tuple[Fraction, int]:
        """Cost and length of a plan of this weight."""
        return Fraction(weight - weight % self._LONGEST, self.unit), weight % self._LONGEST


def relevant_facts(goal: Condition, actions: list[GroundAction]) -> frozenset[int]:
    """Facts that some chain of the human's own actions needs for his goal."""
    makers: dict[tuple[int, bool], list[GroundAction]] = {}
    for action in actions:
        for fact in action.add:
            makers.setdefault((fact, True), []).append(action)
        for fact in action.delete:
            makers.setdefault((fact, False), []).append(action)
    pending = [(fact, True) for fact in goal.positive] + [(fact, False) for fact in goal.negative]
    needed = set(pending)
    while pending:
        for action in makers.get(pending.pop(), ()):
            for literal in (*((f, True) for f in action.pre), *((f, False) for f in action.neg)):
                if literal not in needed:
                    needed.add(literal)
                    pending.append(literal)
    return frozenset(fact for fact, _ in needed)


def own_operators(task: Task) -> tuple[tuple[Operator, ...], frozenset[int], Weights]:
    """The human's useful own actions, the relevant facts, and the weights."""
    own = [task.actions[i] for i in task.human_actions]
    weights = Weights(own)
    facts = relevant_facts(task.goal, own)
    cost_weights = {cost: weights.of(cost, 1) for cost in {action.cost for action in own}}
    operators = []
    for action in own:
        add, delete = facts.intersection(action.add), facts.intersection(action.delete)
        if add or delete:
            pre, neg = frozenset(action.pre), frozenset(action.neg)
            if pre <= facts and neg <= facts:
                operators.append(Operator(pre, neg, add, delete, cost_weights[action.cost]))
    return tuple(operators), facts, weights
