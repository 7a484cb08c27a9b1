"""Actions that make facts true or consume them, and the groups of facts that are exactly-one under these."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from itertools import chain

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import GroundAction


class Balance:
    """The effects of ground actions, by fact.

    An action *consumes* the facts that it needs and deletes.  Everything is linear in the
    number of actions that touch a group.

    Attributes:
        adds: by action, what it adds.
        adders: by fact, the actions that add it.
        consumers: by fact, the actions that consume it.
        sources: by fact, what is consumed, initially true facts only, where it is made true.
        unbalanced: facts that were added to some group without one of its members being consumed.
    """

    def __init__(
        self, n_facts: int, init: frozenset[int], actions: Sequence[GroundAction], deadline: Deadline
    ) -> None:
        self.init = init
        self.actions = actions
        self.adds = [action.add for action in actions]
        self.unbalanced: set[int] = set()
        self.adders: list[list[int]] = [[] for _ in range(n_facts)]
        self.consumers: list[list[int]] = [[] for _ in range(n_facts)]
        self._strayers: dict[int, list[int]] = {}  # delete it without need
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
                    self._strayers.setdefault(fact, []).append(i)
            if at_first:
                consumed = set(pre).intersection(action.delete)
                for fact in add:
                    if fact not in pre:
                        self.sources.setdefault(fact, []).append(consumed)

    def exactly_one(self, group: set[int]) -> bool:
        """Whether one member is true initially, and exactly one whatever is done."""
        return len(group & self.init) == 1 and not self.misfits(group)

    def misfits(self, group: set[int]) -> set[int]:
        """Members that break the group; none where it is exactly-one."""
        consuming = {*joined(self.consumers, group)}
        adding = Counter(joined(self.adders, group))
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
        consumed = Counter(joined(self.consumers, group))
        misfits: set[int] = set()
        while pending:
            misfits |= pending
            touched = Counter(joined(self.consumers, pending))
            consumed.subtract(touched)
            pending = self._created(group, {i for i in touched if not consumed[i]}) - misfits
        self.unbalanced |= misfits
        return misfits

    def _created(self, group: set[int], creators: AbstractSet[int]) -> set[int]:
        """Members that one of some actions makes true."""
        return {
            fact
            for fact in group.intersection(joined(self.adds, creators))
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
        for member in group & self._strayers.keys():
            if any(group.isdisjoint(self.actions[i].pre) for i in self._strayers[member]):
                dropped.add(member)
        return dropped

    def _standing(self, fact: int) -> tuple[int, int]:
        """The best member among facts that are added together: the one that is consumed most."""
        return len(self.consumers[fact]), -fact


def joined(table: Sequence[Iterable[int]], keys: Iterable[int]) -> Iterator[int]:
    """The entries of a table at some keys, one after the other (by C loops)."""
    return chain.from_iterable(map(table.__getitem__, keys))
