"""Finite-domain variables behind the facts: exactly-one groups.

A group is a set of facts of which exactly one is true in every reachable state
(a position, who holds a kit).  A group is grown from a fact that is true
initially: an action that consumes a member must produce another, one that
produces a member must consume another.  The idea is the mutex groups of SAS+
(Baeckstroem and Nebel 1995), found on ground actions.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from itertools import chain

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import GroundAction

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
    n_facts: int, init: frozenset[int], actions: Sequence[GroundAction], deadline: Deadline | None = None
) -> tuple[Variable, ...]:
    """Partition facts ``0 .. n_facts - 1`` into variables, ascending in their first fact.

    Sound for every input: a group that is not exactly-one under each action is not
    reported.  Not complete: some groups that exist may be missed.

    Args:
        n_facts: how many facts there are.
        init: ids of those that hold in ``I``.
        actions: every ground action.
        deadline: polled; None for no limit.

    Raises:
        LimitReachedError: the deadline came first.
    """
    finder = _GroupFinder(n_facts, init, actions, deadline or Deadline())
    groups = finder.groups()
    grouped = set(chain.from_iterable(groups))
    singles = ((fact,) for fact in range(n_facts) if fact not in grouped)
    return tuple(Variable(facts) for facts in sorted(chain(groups, singles)))


class _GroupFinder:
    """Grows a group from a fact that is true initially, and drops what does not fit.

    An action *consumes* the facts that it needs and deletes.  The group of a seed is
    the closure under "consumes a member, so what it adds is a member"; members break
    the group where an action adds one without consuming one, adds two, or deletes one
    that it need not have found true.  They are excluded, and the closure is taken anew.
    Everything is linear in the number of actions that touch a group.
    """

    def __init__(
        self, n_facts: int, init: frozenset[int], actions: Sequence[GroundAction], deadline: Deadline
    ) -> None:
        self.deadline = deadline
        self.init = init
        self.actions = actions
        self.adds = [action.add for action in actions]
        self.blocked = set(init)  # never members, unless a seed
        self.grouped: set[int] = set()  # members of groups that were found
        self.unbalanced: set[int] = set()  # in some attempt, and not blocked since
        self.adders: list[list[int]] = [[] for _ in range(n_facts)]
        self.consumers: list[list[int]] = [[] for _ in range(n_facts)]
        self.strayers: dict[int, list[int]] = {}  # delete it without need
        self.sources: dict[int, list[set[int]]] = {}
        for i, action in enumerate(deadline.each(actions)):
            pre, add = action.pre, action.add
            for fact in add:
                self.adders[fact].append(i)
            at_first = True
            for fact in action.delete:
                if fact in pre:
                    self.consumers[fact].append(i)
                    at_first = at_first and fact in init
                else:
                    self.strayers.setdefault(fact, []).append(i)
            if at_first:
                consumed = set(pre).intersection(action.delete)
                for fact in add:
                    if fact not in pre:
                        self.sources.setdefault(fact, []).append(consumed)

    def groups(self) -> list[tuple[int, ...]]:
        found = []
        for seed in self.deadline.each(sorted(self.init)):
            if self.consumers[seed]:
                group = self._grow(seed)
                if len(group) > 1:
                    found.append(tuple(sorted(group)))
                    self._set_apart(group)
        return found

    def _set_apart(self, group: set[int]) -> None:
        """Bar the members of a group that was found from the groups to come.

        What an action adds that consumes such members only would be unbalanced in each of
        those as well.  Facts that were so before are barred here, once instead of every time.
        """
        self.blocked |= group
        self.grouped |= group
        for i in {*_joined(self.consumers, group)}:
            if not self.unbalanced.isdisjoint(self.adds[i]):
                action = self.actions[i]
                if self.grouped.issuperset([fact for fact in action.delete if fact in action.pre]):
                    self.blocked.update([fact for fact in action.add if fact not in action.pre])
        self.unbalanced -= self.blocked

    def _grow(self, seed: int) -> set[int]:
        """The group of a seed; empty if there is none."""
        if self._appears_otherwise(seed, seed):
            return set()
        barred = set(self.blocked)
        for _ in range(_MAX_ATTEMPTS):
            self.deadline.check()
            group = self._closure(seed, barred)
            misfits = self._misfits(group)
            if not misfits:
                return group
            if seed in misfits:
                return set()
            barred |= misfits
        return set()

    def _closure(self, seed: int, barred: set[int]) -> set[int]:
        group = {seed}
        wave = group
        while wave:
            self.deadline.tick()
            wave = {*_joined(self.adds, _joined(self.consumers, wave))} - group - barred
            wave -= {fact for fact in wave & self.sources.keys() if self._appears_otherwise(fact, seed)}
            group |= wave
        return group

    def _appears_otherwise(self, fact: int, seed: int) -> bool:
        """Whether an action adds a fact and consumes nothing, or only other initial facts."""
        return any(seed not in consumed for consumed in self.sources.get(fact, ()))

    def _misfits(self, group: set[int]) -> set[int]:
        """Members that break the group; none where it is exactly-one."""
        consuming = {*_joined(self.consumers, group)}
        adding = Counter(_joined(self.adders, group))
        return (
            self._unbalanced(group, adding.keys() - consuming)
            or self._beside(group, [i for i, n in adding.items() if n > 1 and i in consuming])
            or self._dropped(group, consuming - adding.keys())
        )

    def _unbalanced(self, group: set[int], creators: AbstractSet[int]) -> set[int]:
        """Members that an action adds without consuming a member, directly or in the end."""
        pending = self._created(group, creators)
        if not pending:
            return set()
        consumed = Counter(_joined(self.consumers, group))
        misfits: set[int] = set()
        while pending:
            misfits |= pending
            touched = Counter(_joined(self.consumers, pending))
            consumed.subtract(touched)
            pending = self._created(group, {i for i in touched if not consumed[i]}) - misfits
        self.unbalanced |= misfits
        return misfits

    def _created(self, group: set[int], creators: AbstractSet[int]) -> set[int]:
        """Members that one of some actions makes true."""
        return {
            fact
            for fact in group.intersection(_joined(self.adds, creators))
            if any(i in creators and fact not in self.actions[i].pre for i in self.adders[fact])
        }

    def _beside(self, group: set[int], adding_more: Iterable[int]) -> set[int]:
        """Members that are added beside another one."""
        beside: set[int] = set()
        for i in adding_more:
            beside.update(sorted(group.intersection(self.adds[i]), key=self._standing)[:-1])
        return beside

    def _dropped(self, group: set[int], adding_none: Iterable[int]) -> set[int]:
        """Members that are deleted without a successor."""
        dropped: set[int] = set()
        for i in adding_none:
            action = self.actions[i]
            dropped.update(group.intersection(action.delete).intersection(action.pre))
        for member in group & self.strayers.keys():
            if any(group.isdisjoint(self.actions[i].pre) for i in self.strayers[member]):
                dropped.add(member)
        return dropped

    def _standing(self, fact: int) -> tuple[int, int]:
        """The best member among facts that are added together: the one that is consumed most."""
        return len(self.consumers[fact]), -fact


def _joined(table: Sequence[Iterable[int]], keys: Iterable[int]) -> Iterator[int]:
    """The entries of a table at some keys, one after the other (by C loops)."""
    return chain.from_iterable(map(table.__getitem__, keys))
