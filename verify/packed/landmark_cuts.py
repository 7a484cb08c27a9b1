"""Landmarks of the delete relaxation as lower bounds: the LM-cut (Helmert and Domshlak 2009).

A landmark is a set of operators of which every plan from a state has one at least.  Weights are dealt out
over several landmarks, none of it twice, so what they weigh adds up to no more than any plan does.

Why a cut is a landmark: let every operator hang on one of its needs, its support.  Whatever is reached, if
nothing is ever deleted, is reached by a chain of operators from supports to what they add, which begins
with facts that are true.  The zone holds the goal and, with what a free operator adds, its support; as
long as the goal is not free, nothing that is true at first is in it.  So each chain to the goal enters the
zone, by an operator that adds a fact of it and whose support is outside: these are the cut, and each of
them has weight left.  Any choice of supports would do; the dearest need, as h-max has it, gives good cuts.
A plan with deletes, and with facts that have to be false, is one of the relaxation as well.
"""

from collections.abc import Collection, Sequence
from heapq import heapify, heappop, heappush
from typing import Final, NamedTuple

import numpy as np

from verify.packed.operators import FAR, Ints, PackedOperator

_NEVER: Final = int(FAR)


class Cuts(NamedTuple):
    """Landmarks from one state.

    Attributes:
        bound: what they weigh together; ``FAR`` where the goal is out of reach.
        operators: those of the landmarks.
        shares: of each, what landmarks with it weigh; no more than the operator.  A plan from the operator's
            result, with the operator before it, is one from the state, so that all other landmarks are
            those of the result, too.
    """

    bound: int
    operators: Ints
    shares: Ints


class LandmarkCuts:
    """The landmarks of a problem.

    Args:
        operators: what may be done; facts that they forbid or delete are not looked at.
        facts: those that matter; others are taken to be true.
        goal: facts that have to be true.
        rarest: whether of needs that are equally dear the one counts that the fewest operators add; else
            whichever comes.
    """

    def __init__(
        self, operators: Sequence[PackedOperator], facts: frozenset[int], goal: Sequence[int], *, rarest: bool
    ) -> None:
        number = {fact: k for k, fact in enumerate(sorted(facts), start=1)}
        self._number = number
        self._goal = len(number) + 1
        needs = [tuple(number[f] for f in each.pre if f in number) or (0,) for each in operators]
        adds = [tuple(number[f] for f in each.add if f in number) for each in operators]
        self._needs = [*needs, tuple(number[f] for f in goal if f in number) or (0,)]
        self._adds = [*adds, (self._goal,)]
        self._weights = [*(each.weight for each in operators), 0]
        self._needed_by: list[list[int]] = [[] for _ in range(self._goal + 1)]
        self._added_by: list[list[int]] = [[] for _ in range(self._goal + 1)]
        for i, (need, add) in enumerate(zip(self._needs, self._adds, strict=True)):
            for fact in need:
                self._needed_by[fact].append(i)
            for fact in add:
                self._added_by[fact].append(i)
        self._rarest = rarest
        if rarest:
            added = [len(by) for by in self._added_by]
            self._needs = [tuple(sorted(need, key=added.__getitem__)) for need in self._needs]

    def __call__(self, state: frozenset[int]) -> Cuts:
        """The landmarks from a state."""
        weights, shares = self._weights.copy(), dict[int, int]()
        true = [0, *(self._number[fact] for fact in state if fact in self._number)]
        level, support = self._levels(true, weights)
        if level[self._goal] >= _NEVER:
            return Cuts(_NEVER, _array(()), _array(()))
        total = 0
        while level[self._goal]:
            cut = self._cut(weights, support)
            share = min(weights[i] for i in cut)
            total += share
            for i in cut:
                weights[i] -= share
                shares[i] = shares.get(i, 0) + share
            self._lower(cut, weights, level, support)
        return Cuts(total, _array(shares), _array(shares.values()))

    def _levels(self, true: list[int], weights: list[int]) -> tuple[list[int], list[int]]:
        """What each fact costs at least (h-max), and each operator's dearest need; -1: out of reach."""
        needed_by, adds = self._needed_by, self._adds
        level = [_NEVER] * (self._goal + 1)
        for fact in true:
            level[fact] = 0
        queue = [(0, fact) for fact in true]
        heapify(queue)
        missing = [len(need) for need in self._needs]
        support = [-1] * len(missing)
        while queue:
            here, fact = heappop(queue)
            if here > level[fact]:
                continue
            for i in needed_by[fact]:
                missing[i] -= 1
                if not missing[i]:
                    support[i] = fact
                    there = here + weights[i]
                    for added in adds[i]:
                        if there < level[added]:
                            level[added] = there
                            heappush(queue, (there, added))
        if self._rarest:
            for i, need in enumerate(self._needs):
                if support[i] >= 0 and len(need) > 1:
                    support[i] = max(need, key=level.__getitem__)
        return level, support

    def _cut(self, weights: list[int], support: list[int]) -> list[int]:
        """The operators by which chains of supports enter what is free from there to the goal."""
        zone, pending = {self._goal}, [self._goal]
        crossing: set[int] = set()
        while pending:
            for i in self._added_by[pending.pop()]:
                fact = support[i]
                if fact < 0 or fact in zone:
                    continue
                if weights[i]:
                    crossing.add(i)
                else:
                    zone.add(fact)
                    pending.append(fact)
        return [i for i in crossing if support[i] not in zone]

    def _lower(self, cut: list[int], weights: list[int], level: list[int], support: list[int]) -> None:
        """Bring levels and supports up to date where operators have become cheaper."""
        adds, needs, needed_by = self._adds, self._needs, self._needed_by
        queue: list[tuple[int, int]] = []
        for i in cut:
            there = level[support[i]] + weights[i]
            for added in adds[i]:
                if there < level[added]:
                    level[added] = there
                    heappush(queue, (there, added))
        while queue:
            here, fact = heappop(queue)
            if here > level[fact]:
                continue
            for i in needed_by[fact]:
                if support[i] != fact:
                    continue
                dearest = max(needs[i], key=level.__getitem__)
                support[i] = dearest
                there = level[dearest] + weights[i]
                for added in adds[i]:
                    if there < level[added]:
                        level[added] = there
                        heappush(queue, (there, added))


def _array(numbers: Collection[int]) -> Ints:
    return np.fromiter(numbers, np.int64, len(numbers))
