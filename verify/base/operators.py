"""The human's own actions as the checker's own search sees them."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Final

from serendipity.model import Deadline, GroundAction, Task
from verify.base.execution import unchosen
from verify.base.fact_bits import BitCondition, BitOperator, BitOperators, FactBits
from verify.limits import limits

_LONGEST: Final = 10**9
"""More actions than any plan has that is ever compared."""

_EPOCH: Final = 1 << 20
"""What an epoch weighs in time, where so many epochs or actions are more than any plan has."""


Whole = tuple[GroundAction, int, int]
"""An action with all that is due after it, as one; its weight, and its epochs."""


def one_after_the_other(first: GroundAction, second: GroundAction) -> GroundAction:
    """Two actions as one; of facts that the first settles, the second's conditions have to be as it does.

    What can't be has a precondition that it also wants false.
    """
    add, delete = set(first.add), set(first.delete) - set(first.add)
    pre, neg = set(first.pre) | set(second.pre) - add, set(first.neg) | set(second.neg) - delete
    changed = (add - set(second.delete)) | set(second.add)
    removed = (delete | set(second.delete)) - changed
    return replace(
        first,
        pre=tuple(sorted(pre | (set(second.neg) & add))),
        neg=tuple(sorted(neg | (set(second.pre) & delete))),
        add=tuple(sorted(changed)),
        delete=tuple(sorted(removed)),
    )


class OwnActions:
    """The human's own actions, turned into operators when they are first asked for.

    Operators are reduced to the facts that can matter to the human.  Their weight orders plans by cost, then
    by length: a cost of 1 weighs as much as ``_LONGEST`` actions.  In time length is the number of epochs,
    and then what begins in them (semantics 10.3).

    Attributes:
        ids: the actions' ids.
        facts: facts that an own action needs or that their goal names; no other matters to them.
        bits: these facts as bits.
        goal: ``G_H`` in bits.
    """

    def __init__(self, task: Task, deadline: Deadline) -> None:
        self._task, self._deadline = task, deadline
        self.ids = task.human_actions
        facts = {*task.goal.positive, *task.goal.negative}
        denominators = set()
        for i in deadline.each(self.ids):
            action = task.actions[i]
            facts.update(action.pre, action.neg)
            denominators.add(action.cost.denominator)
        self._unchosen = unchosen(task)
        for i in self._unchosen:  # with others, too
            if task.human in task.actions[i].participants:
                denominators.add(task.actions[i].cost.denominator)
        self.facts = frozenset(facts)
        self.bits = FactBits(facts)
        self.goal = BitCondition(self.bits.of(task.goal.positive), self.bits.of(task.goal.negative))
        self._epoch, longest = (_EPOCH, _EPOCH) if self._unchosen else (0, _LONGEST)
        self._least_cost = longest * (self._epoch or 1)
        self._unit = lcm(*denominators) * self._least_cost
        self._weights: dict[tuple[int, int], int] = {}
        self._wholes: dict[int, tuple[Whole, ...]] = {}

    @property
    def private(self) -> frozenset[int]:
        """Facts of variables that robots alone never change (position, what is held), but not too many."""
        task, shared = self._task, set[int]()
        for action in self._deadline.each(task.actions):
            if task.human not in action.participants:
                shared.update(action.add, action.delete)
        kept: set[int] = set()
        size = 1
        for variable in sorted(task.variables, key=lambda v: -len(v.facts)):
            facts = self.facts.intersection(variable.facts)
            values = len(facts) + 1
            if facts and shared.isdisjoint(variable.facts) and size * values <= limits().projected_states:
                kept |= facts
                size *= values
        return frozenset(kept)

    @cached_property
    def operators(self) -> tuple[BitOperator, ...]:
        """The actions, each with all that is due after it, labelled by their ids."""
        each = ((i, whole) for i in self._deadline.each(self.ids) for whole in self.wholes(i))
        return tuple(self.bits.operator(*whole[:2], i) for i, whole in each)

    @cached_property
    def moves(self) -> BitOperators:
        """The same, to be looked up by state."""
        return BitOperators(self.operators, self._deadline)

    def weight(self, action: int) -> int:
        """The weight of an action."""
        cost = self._task.actions[action].cost
        ratio = (cost.numerator, cost.denominator)
        if ratio not in self._weights:
            self._weights[ratio] = int(cost * self._unit) + self._epoch
        return self._weights[ratio] + (action not in self._unchosen)

    def wholes(self, action: int) -> tuple[Whole, ...]:
        """An action with all that is due after it, as one; several where what is due has variants.

        Nobody chooses anything while the human is at something (semantics 10.1), so the states between matter
        to nobody; one in which they are at it already is left by what is still due.
        """
        parts = [action]
        while parts:
            following = self._following(parts[-1])
            unknown = [part for part in following if part not in self._wholes]
            if not unknown:
                part = parts.pop()
                self._wholes[part] = self._joined(part, following)
            parts += unknown
        return self._wholes[action]

    def _joined(self, action: int, following: Sequence[int]) -> tuple[Whole, ...]:
        ground, weight = self._task.actions[action], self.weight(action)
        rests = [rest for part in following for rest in self._wholes[part]]
        ways = [
            (one_after_the_other(ground, rest), weight + more, epochs + 1) for rest, more, epochs in rests
        ]
        possible = [way for way in ways if set(way[0].pre).isdisjoint(way[0].neg)]
        # One that can't be alone may be beside others, who change what it asks for meanwhile.
        return tuple(possible or ways[:1]) if following else ((ground, weight, 1),)

    def _following(self, action: int) -> list[int]:
        """What may be due for the human once an action is done."""
        due, actions = self._task.due_for, self._task.actions
        ids = (i for fact in actions[action].add for each in due.get(fact, ()) for i in each)
        return [i for i in ids if actions[i].participants == (self._task.human,)]

    def heaviest(self, cost: Fraction) -> int:
        """The most that a plan weighs which costs no more."""
        return int(cost * self._unit) + self._least_cost - 1

    def split(self, weight: int) -> tuple[Fraction, int]:
        """Cost and length of a plan of a weight."""
        rest = weight % self._least_cost
        return Fraction(weight - rest, self._unit), rest // (self._epoch or 1)

    def may_reach_goal(self, state: int, deadline: Deadline) -> bool:
        """Whether that is so if what has been true, or false, counts as that from then on."""
        true, false = state, self.bits.all & ~state
        waiting: Sequence[BitOperator] = self.operators
        while self.goal.pre & ~true or self.goal.neg & ~false:
            later = [op for op in deadline.each(waiting) if op.pre & ~true or op.neg & ~false]
            if len(later) == len(waiting):
                return False
            for op in deadline.each(waiting):
                if not (op.pre & ~true or op.neg & ~false):
                    true, false = true | op.add, false | op.delete
            waiting = later
        return True
