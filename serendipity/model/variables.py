"""Finite-domain variables behind the facts: exactly-one groups.

A group is a set of facts of which exactly one is true in every reachable state
(a position, who holds a kit).  A group is grown from a fact that is true
initially: an action that consumes a member must produce another, one that
produces a member must consume another.  The idea is the mutex groups of SAS+
(Baeckstroem and Nebel 1995), found on ground actions.
"""

from collections.abc import Iterable, Sequence
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
    def __init__(self, n_facts: int, init: frozenset[int], actions: Sequence[GroundAction]) -> None:
        self.init = init
        self.taken: set[int] = set()
        self.adders: list[list[GroundAction]] = [[] for _ in range(n_facts)]
        self.deleters: list[list[GroundAction]] = [[] for _ in range(n_facts)]
        self.consumed: set[int] = set()
        for action in actions:
            for fact in action.add:
                self.adders[fact].append(action)
            for fact in action.delete:
                self.deleters[fact].append(action)
            self.consumed.update(fact for fact in action.delete if fact in action.pre)

    def groups(self) -> list[tuple[int, ...]]:
        found = []
        for seed in sorted(self.init):
            if seed in self.taken or not self.deleters[seed]:
                continue
            group = self._grow(seed)
            if group is not None and len(group) > 1:
                found.append(tuple(sorted(group)))
                self.taken |= group
        return found

    def _grow(self, seed: int) -> set[int] | None:
        """Attempts that rule out, one by one, the members that can't be balanced."""
        excluded: set[int] = set()
        for _ in range(_MAX_ATTEMPTS):
            group, culprit = self._attempt(seed, excluded)
            if culprit is None:
                return group if self._holds(frozenset(group)) else None
            if culprit == seed:
                return None
            excluded.add(culprit)
        return None

    def _attempt(self, seed: int, excluded: set[int]) -> tuple[set[int], int | None]:
        """A group closed under balancing, or the member whose actions can't be balanced."""
        group, pending = {seed}, [seed]
        while pending:
            member = pending.pop()
            for action in chain(self.deleters[member], self.adders[member]):
                candidates = _needed_partners(action, group)
                if candidates is None:
                    continue
                usable = [
                    f
                    for f in candidates
                    if f not in self.init and f not in excluded and f not in self.taken
                ]
                if not usable:
                    return group, member
                # A fact that is never consumed is a record of what happened, not a value.
                partner = min(usable, key=lambda f: (f not in self.consumed, len(self.adders[f]), f))
                group.add(partner)
                pending.append(partner)
        return group, None

    def _holds(self, group: frozenset[int]) -> bool:
        touching = chain.from_iterable(chain(self.adders[f], self.deleters[f]) for f in group)
        return all(keeps_exactly_one(group, action) for action in touching)


def _needed_partners(action: GroundAction, group: set[int]) -> Iterable[int] | None:
    """Facts of which one must join ``group`` for the action to keep it; None if it does."""
    consumed = any(f in group and f in action.pre for f in action.delete)
    produced = any(f in group for f in action.add)
    if consumed and not produced:
        return action.add
    if produced and not consumed and not any(f in group for f in action.pre):
        return [f for f in action.delete if f in action.pre]
    return None
