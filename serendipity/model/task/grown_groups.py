"""Exactly-one groups, each grown from a fact that is true initially.

An action that consumes a member must produce another, one that produces a member must
consume another.  The idea is the mutex groups of SAS+ (Baeckstroem and Nebel 1995), found on
ground actions.
"""

from collections.abc import Collection, Iterable
from typing import Final

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.exactly_one import Balance, joined

Group = tuple[int, ...]
"""Ids of facts, ascending, two or more: exactly one is true in every reachable state."""

_MAX_ATTEMPTS: Final = 64


def grown_groups(
    balance: Balance, deadline: Deadline, apart: Iterable[Group] = (), first: Collection[int] = ()
) -> list[Group]:
    """Groups that share no fact, neither with each other nor with known ones (``apart``).

    Args:
        first: facts that groups are grown from before all others.
    """
    return _Grower(balance, deadline, apart).groups(first)


class _Grower:
    """Grows a group from a fact that is true initially, and drops what does not fit.

    The group of a seed is the closure under "consumes a member, so what it adds is a member";
    members break the group where an action adds one without consuming one, adds two, or deletes
    one that it need not have found true.  They are excluded, and the closure is taken anew.
    """

    def __init__(self, balance: Balance, deadline: Deadline, apart: Iterable[Group]) -> None:
        self.balance = balance
        self.deadline = deadline
        self.blocked = set(balance.init)  # never members, unless a seed
        self.grouped: set[int] = set()  # members of groups that were found
        for group in deadline.each(apart):
            self._set_apart(group)

    def groups(self, first: Collection[int]) -> list[Group]:
        found = []
        seeds = sorted(self.balance.init - self.grouped, key=lambda fact: (fact not in first, fact))
        for seed in self.deadline.each(seeds):
            if self.balance.consumers[seed]:
                group = tuple(sorted(self._grow(seed)))
                if len(group) > 1:
                    found.append(group)
                    self._set_apart(group)
        return found

    def _set_apart(self, group: Group) -> None:
        """Bar the members of a group that was found from the groups to come.

        What an action adds that consumes such members only would be unbalanced in each of
        those as well.  Facts that were so before are barred here, once instead of every time.
        """
        adds, actions, unbalanced = self.balance.adds, self.balance.actions, self.balance.unbalanced
        self.blocked.update(group)
        self.grouped.update(group)
        for i in {*joined(self.balance.consumers, group)}:
            if not unbalanced.isdisjoint(adds[i]):
                action = actions[i]
                if self.grouped.issuperset([fact for fact in action.delete if fact in action.pre]):
                    self.blocked.update([fact for fact in action.add if fact not in action.pre])
        unbalanced -= self.blocked

    def _grow(self, seed: int) -> set[int]:
        """The group of a seed; empty if there is none."""
        if self._appears_otherwise(seed, seed):
            return set()
        barred = set(self.blocked)
        for _ in range(_MAX_ATTEMPTS):
            self.deadline.check()
            group = self._closure(seed, barred)
            misfits = self.balance.misfits(group)
            if not misfits:
                return group
            if seed in misfits:
                return set()
            barred |= misfits
        return set()

    def _closure(self, seed: int, barred: set[int]) -> set[int]:
        adds, consumers, sources = self.balance.adds, self.balance.consumers, self.balance.sources
        group = {seed}
        wave = group
        while wave:
            self.deadline.tick()
            wave = {*joined(adds, joined(consumers, wave))} - group - barred
            wave -= {fact for fact in wave & sources.keys() if self._appears_otherwise(fact, seed)}
            group |= wave
        return group

    def _appears_otherwise(self, fact: int, seed: int) -> bool:
        """Whether an action adds a fact and consumes nothing, or only other initial facts."""
        return any(seed not in consumed for consumed in self.balance.sources.get(fact, ()))
