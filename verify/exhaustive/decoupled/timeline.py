"""One robot beside the human's timetable: what it can have made of the world after each epoch, at what cost.

Other robots are left out, but for this: a fact that one of them can add is taken for true where the robot
needs it, one that they can delete for false where the robot forbids it.  Then whatever the robot does in a
plan of all, it can do here, at the same cost.  For let a fact that nobody else can add be true there: who
changed it last is the robot or the human, or it was true at first, so that it is true here, too.  In the same
way the fact has the same value at the end, if the robot was the last of the robots to change it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from serendipity.model import GroundAction
from verify.base.execution import conflicting, grouped
from verify.base.relevance import Relevant
from verify.base.subproblem import Subproblem
from verify.exhaustive.decoupled.rows import Collected, RowLayer
from verify.exhaustive.team import Bools
from verify.limits import limits
from verify.packed.layout import PackedLayout, Words
from verify.packed.operators import OperatorTable, PackedOperator

_AT_ONCE: Final = 4_096


@dataclass(frozen=True, slots=True)
class RobotPart:
    """A robot's part of the world: its actions, and the facts that they look at and change.

    Attributes:
        actions: ids of what it may do.
        added: facts that other robots can add.
        deleted: facts that other robots can delete.
        changed: facts that it can change and that matter to the human.
        facts: those that have to be followed: these, and what its actions and ``pi_H`` look at.
    """

    actions: tuple[int, ...]
    added: frozenset[int]
    deleted: frozenset[int]
    changed: frozenset[int]
    facts: frozenset[int]


def parts(question: Subproblem, relevant: Relevant, matters: frozenset[int]) -> list[RobotPart]:
    """The robots' parts.

    Args:
        question: each of its actions has one participant.
        matters: facts that the human looks at when they go on alone.
    """
    task = question.task
    by_robot = grouped((who, i) for i in relevant.actions for who in task.actions[i].participants)
    by_robot.pop(task.human, None)
    adds = {who: _union(task.actions[i].add for i in own) for who, own in by_robot.items()}
    deletes = {who: _union(task.actions[i].delete for i in own) for who, own in by_robot.items()}
    planned = _union((*relevant.pre[i], *relevant.neg[i]) for i in question.human_plan if i in relevant.pre)
    found = []
    for who, own in by_robot.items():
        added = _union(facts for other, facts in adds.items() if other != who)
        deleted = _union(facts for other, facts in deletes.items() if other != who)
        asked = _union(relevant.pre[i] for i in own) - added | _union(relevant.neg[i] for i in own) - deleted
        changed = (adds[who] | deletes[who]) & relevant.facts
        followed = asked | changed & (matters | planned)
        found.append(RobotPart(tuple(own), added, deleted, changed & matters, followed))
    return found


def _union(sets: Iterable[Iterable[int]]) -> frozenset[int]:
    return frozenset(fact for facts in sets for fact in facts)


class RobotTimeline:
    """A robot's states, epoch by epoch.

    Attributes:
        layer: its states after the epochs that were followed.
    """

    def __init__(
        self, question: Subproblem, relevant: Relevant, part: RobotPart, layout: PackedLayout
    ) -> None:
        self.part = part
        self._question, self._relevant, self.layout = question, relevant, layout
        self._deadline = question.deadline
        self._table = OperatorTable(layout, [self._operator(i) for i in self._deadline.each(part.actions)])
        own = enumerate(question.task.actions[i] for i in part.actions)
        mentioned = ((k, {*one.pre, *one.neg, *one.add, *one.delete}) for k, one in own)
        self._mentioning = grouped((fact, number) for number, facts in mentioned for fact in facts)
        start = layout.pack([question.task.init & part.facts])
        self.layer = RowLayer(start, np.zeros(1, np.int64), np.ones(1, bool))
        self._free: RowLayer | None = None

    def _operator(self, i: int) -> PackedOperator:
        action, facts = self._question.task.actions[i], self.part.facts
        return PackedOperator(
            tuple(f for f in self._relevant.pre[i] if f not in self.part.added),
            tuple(f for f in self._relevant.neg[i] if f not in self.part.deleted),
            tuple(f for f in action.add if f in facts),
            tuple(f for f in action.delete if f in facts),
            self._question.prices.team[i],
        )

    def ends(self) -> RowLayer:
        """The states after one more epoch, beside nothing."""
        if self._free is None:
            self._free = self._moved(self.layer, None)
        return self._free

    def follow(self, step: int) -> None:
        """One more epoch, beside an action of the human's."""
        human = self._question.task.actions[step]
        in_the_way, apart = self._beside(human)
        layer = self.ends() if apart else self._moved(self.layer.only(self._allow(step)), ~in_the_way)
        add, delete = self._bits(human.add), self._bits(human.delete)
        fresh = layer.fresh if apart else np.ones(len(layer.fresh), bool)
        followed = Collected(self.layout.words, None, self._deadline)
        followed.add((layer.rows & ~delete) | add, layer.paid, fresh)
        self.layer = followed.layer()
        self._free = None

    def _bits(self, facts: Sequence[int]) -> Words:
        return self.layout.pack([self.part.facts.intersection(facts)])

    def _allow(self, step: int) -> Bools:
        """After which states the human can go on, unless others see to what is missing."""
        facts, part = self.part.facts, self.part
        needs = [f for f in self._relevant.pre.get(step, ()) if f in facts and f not in part.added]
        forbids = [f for f in self._relevant.neg.get(step, ()) if f in facts and f not in part.deleted]
        need, forbid = self.layout.pack([frozenset(needs)]), self.layout.pack([frozenset(forbids)])
        rows = self.layer.rows
        allowed: Bools = ((rows & need) == need).all(axis=1) & ((rows & forbid) == 0).all(axis=1)
        return allowed

    def _beside(self, human: GroundAction) -> tuple[Bools, bool]:
        """Actions that can't be done beside one of the human's; and if none has to do with it.

        Then it makes no difference which of the two comes first, so that what could be done before it
        brings about nothing new after it.
        """
        task, strict = self._question.task, self._question.options.strict
        touched = {*human.pre, *human.neg, *human.add, *human.delete}
        numbers = {number for fact in touched for number in self._mentioning.get(fact, ())}
        in_the_way, apart = np.zeros(len(self.part.actions), bool), True
        for number in numbers:
            own = task.actions[self.part.actions[number]]
            in_the_way[number] = conflicting(own, human, strict=strict)
            looks = _looks_at(own, human) or _looks_at(human, own)
            apart = apart and not in_the_way[number] and not looks
        return in_the_way, apart

    def _moved(self, layer: RowLayer, allowed: Bools | None) -> RowLayer:
        """The states after the robot's part of an epoch."""
        begin = np.flatnonzero(layer.fresh)
        found = Collected(self.layout.words, limits().robot_states, self._deadline)
        found.add(layer.rows, layer.paid)
        for first in range(0, len(begin), _AT_ONCE):
            self._deadline.check()
            some = begin[first : first + _AT_ONCE]
            rows, chosen = self._table.applicable(layer.rows[some])
            if allowed is not None:
                rows, chosen = rows[allowed[chosen]], chosen[allowed[chosen]]
            after = self._table.after(layer.rows[some[rows]], chosen)
            cost = layer.paid[some[rows]] + self._table.weight[chosen]
            found.add(after, cost, fresh=True)
        return found.layer()


def _looks_at(one: GroundAction, other: GroundAction) -> bool:
    """True if an action asks about a fact that another changes."""
    return not {*one.pre, *one.neg}.isdisjoint((*other.add, *other.delete))
