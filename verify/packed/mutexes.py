"""Which facts are never true together, and which actions never happen (h2, Haslum and Geffner 2000).

Every pair of facts that may be true together is found, from the pairs that are at first: an action whose
preconditions may pair by pair be true together makes what it adds true together, and beside whatever may
be true beside its preconditions and is not deleted.  What is not found is true in no state that is reached
from one in which all pairs are found ones.
"""

from collections.abc import Collection, Iterable, Sequence

from serendipity.model import Deadline
from verify.packed.bits import bits_of, numbers_in
from verify.packed.layout import Effects


class ReachablePairs:
    """The pairs of facts that may be true together.

    Args:
        actions: all that may ever happen; with circles of actions, if several may happen at once.

    Attributes:
        beside: by fact, the facts that may be true beside it as bits; 0 where it can't be true at all.
    """

    def __init__(
        self, facts: int, init: Iterable[int], actions: Sequence[Effects], deadline: Deadline
    ) -> None:
        self.beside = [0] * facts
        self._stale = set(init)
        first = bits_of(self._stale)
        for fact in self._stale:
            self.beside[fact] = first
        waiting = [(action.pre, action.add, ~bits_of(action.delete)) for action in deadline.each(actions)]
        fresh = True  # what needs nothing happens where nothing is true, too
        while fresh or self._stale:
            fresh, stale, self._stale = False, self._stale, set()
            for pre, add, kept in deadline.each(waiting):
                if not pre or not stale.isdisjoint(pre):
                    self._happen(pre, add, kept)

    def possible(self, facts: Collection[int]) -> bool:
        """True if some facts may be true together."""
        wanted = bits_of(facts)
        return all(not wanted & ~self.beside[fact] for fact in facts)

    def _happen(self, pre: tuple[int, ...], add: tuple[int, ...], kept: int) -> None:
        beside, wanted = -1, bits_of(pre)
        for fact in pre:
            row = self.beside[fact]
            if wanted & ~row:
                return
            beside &= row
        if beside < 0:  # needs nothing: beside whatever may be true
            beside = bits_of(fact for fact, row in enumerate(self.beside) if row)
        row = beside & kept | bits_of(add)
        for fact in add:
            new = row & ~self.beside[fact]
            if new:
                self.beside[fact] |= new
                self._stale.add(fact)
                mine = 1 << fact
                for other in numbers_in(new):
                    self.beside[other] |= mine
                    self._stale.add(other)


def exclusive_groups(pairs: ReachablePairs, facts: Iterable[int], deadline: Deadline) -> list[frozenset[int]]:
    """Disjoint groups of facts of which no two are ever true together, the largest first."""
    every = bits_of(facts)
    against = {f: every & ~pairs.beside[f] & ~(1 << f) for f in facts}
    cliques = {_clique(seed, against) for seed in deadline.each(against)}
    chosen: list[frozenset[int]] = []
    while cliques:
        deadline.check()
        best = max(cliques, key=lambda bits: (bits.bit_count(), bits))
        if best.bit_count() < 2:
            break
        chosen.append(frozenset(numbers_in(best)))
        cliques = {clique & ~best for clique in cliques}
    return chosen


def _clique(seed: int, against: dict[int, int]) -> int:
    """A largest group with a fact, as greed finds it."""
    members, candidates = 1 << seed, against[seed]
    while candidates:
        facts = list(numbers_in(candidates))
        beside = [(against[fact] & candidates).bit_count() for fact in facts]
        most = max(beside)
        best = [fact for fact, count in zip(facts, beside, strict=True) if count == most]
        for fact in best if most == len(facts) - 1 else best[:1]:  # who excludes all others stays the best
            members |= 1 << fact
            candidates &= against[fact]
    return members
