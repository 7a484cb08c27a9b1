"""Finite-domain variables behind the facts: exactly-one groups.

A group is a set of facts of which exactly one is true in every reachable state
(a position, who holds a kit).  A group is grown from a fact that is true
initially: an action that consumes a member must produce another, one that
produces a member must consume another.  The idea is the mutex groups of SAS+
(Baeckstroem and Nebel 1995), found on ground actions.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

from serendipity.model.actions import GroundAction

_MAX_ATTEMPTS = 64


@dataclass(frozen=True, slots=True)
class Variable:
    """A finite-domain variable.

    Attributes:
        facts: ids of its facts, ascending.  Two or more: exactly one is true in every
            reachable state.  One: a fact by itself, true or false.
    """

    facts: tuple[int, ...]

    @property
    def boolean(self) -> bool:
        """Whether it is a single fact, true or false."""
        return len(self.facts) == 1


def find_variables(
    n_facts: int, init: frozenset[int], actions: Sequence[GroundAction]
) -> tuple[Variable, ...]:
    """Partition facts ``0 .. n_facts - 1`` into variables, ascending in their first fact.

    Sound for every input: a group that is not exactly-one under each action is not
    reported.  Not complete: some groups that exist may be missed.
    """
    finder = _GroupFinder(n_facts, init, actions)
    groups = finder.groups()
    grouped = set(chain.from_iterable(groups))
    singles = ((fact,) for fact in range(n_facts) if fact not in grouped)
    return tuple(Variable(facts) for facts in sorted(chain(groups, singles)))


def keeps_exactly_one(group: frozenset[int], action: GroundAction) -> bool:
    """Whether ``action``, applied where exactly one of ``group`` is true, keeps it so."""
    needed = group.intersection(action.pre)
    added = group.intersection(action.add)
    deleted = group.intersection(action.delete)
    if len(needed) > 1 or not (added or deleted):
        return True  # never applicable, or does not touch the group
    if len(added) > 1:
        return False
    if not added:
        return bool(needed) and not needed & deleted
    if needed:
        return needed <= deleted or needed == added
    return group - added <= deleted


class _GroupFinder:
    """Grows a group from a fact that is true initially, and drops what does not fit.

    An action *consumes* the facts that it needs and deletes.  The group of a seed is
    the closure under "consumes a member, so what it adds is a member"; members break
    the group where an action adds one without consuming one, adds two, or deletes one
    that it need not have found true.  They are excluded, and the closure is taken anew.
    Everything is linear in the number of actions that touch a group.
    """

    def __init__(self, n_facts: int, init: frozenset[int], actions: Sequence[GroundAction]) -> None:
        self.init = init
        self.actions = actions
        self.blocked = set(init)
        self.adders: list[list[int]] = [[] for _ in range(n_facts)]
        self.consumers: list[list[int]] = [[] for _ in range(n_facts)]
        self.strayers: list[list[int]] = [[] for _ in range(n_facts)]  # delete it without need
        self.sources: dict[int, list[set[int]]] = {}
        for i, action in enumerate(actions):
            pre = action.pre
            consumed = [fact for fact in action.delete if fact in pre]
            for fact in action.add:
                self.adders[fact].append(i)
            for fact in consumed:
                self.consumers[fact].append(i)
            if len(consumed) < len(action.delete):
                for fact in action.delete:
                    if fact not in pre:
                        self.strayers[fact].append(i)
            if init.issuperset(consumed):
                for fact in action.add:
                    if fact not in pre:
                        self.sources.setdefault(fact, []).append(set(consumed))

    def groups(self) -> list[tuple[int, ...]]:
        found = []
        for seed in sorted(self.init):
            if self.consumers[seed]:
                group = self._grow(seed)
                if len(group) > 1:
                    found.append(tuple(sorted(group)))
                    self.blocked |= group
        return found

    def _grow(self, seed: int) -> set[int]:
        """The group of a seed; empty if there is none."""
        excluded: set[int] = set()
        if self._appears_otherwise(seed, seed):
            return set()
        for _ in range(_MAX_ATTEMPTS):
            group = self._closure(seed, excluded)
            misfits = self._unbalanced(group) or self._uneven(group)
            if not misfits:
                return group
            if seed in misfits:
                return set()
            excluded |= misfits
        return set()

    def _closure(self, seed: int, excluded: set[int]) -> set[int]:
        actions, barred = self.actions, self.blocked | excluded
        group, pending = {seed}, [seed]
        while pending:
            for i in self.consumers[pending.pop()]:
                for fact in actions[i].add:
                    if fact not in group and fact not in barred:
                        if self._appears_otherwise(fact, seed):
                            barred.add(fact)
                        else:
                            group.add(fact)
                            pending.append(fact)
        return group

    def _appears_otherwise(self, fact: int, seed: int) -> bool:
        """Whether an action adds a fact and consumes nothing, or only other initial facts."""
        return any(seed not in consumed for consumed in self.sources.get(fact, ()))

    def _unbalanced(self, group: set[int]) -> set[int]:
        """Members that an action adds without consuming a member, directly or in the end."""
        consumed: dict[int, int] = {}
        for member in group:
            for i in self.consumers[member]:
                consumed[i] = consumed.get(i, 0) + 1
        actions = self.actions
        misfits: set[int] = set()
        pending = [
            member
            for member in group
            for i in self.adders[member]
            if i not in consumed and member not in actions[i].pre
        ]
        while pending:
            member = pending.pop()
            if member in misfits:
                continue
            misfits.add(member)
            for i in self.consumers[member]:
                consumed[i] -= 1
                if not consumed[i]:
                    pending += [f for f in actions[i].add if f in group and f not in actions[i].pre]
        return misfits

    def _uneven(self, group: set[int]) -> set[int]:
        """Members that are added beside another one, or else deleted without a successor."""
        actions = self.actions
        beside: set[int] = set()
        dropped: set[int] = set()
        for member in group:
            for i in self.consumers[member]:
                added = [fact for fact in actions[i].add if fact in group]
                if len(added) > 1:
                    beside.update(sorted(added, key=self._standing)[:-1])
                elif not added:
                    dropped.add(member)
            for i in self.strayers[member]:
                if group.isdisjoint(actions[i].pre):
                    dropped.add(member)
        return beside or dropped

    def _standing(self, fact: int) -> tuple[int, int]:
        """Of facts added together, the one that is consumed most makes the best member."""
        return len(self.consumers[fact]), -fact
