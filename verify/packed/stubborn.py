"""Stubborn sets: of operators that commute only some orders are looked at (Wehrle and Helmert 2012).

A set of operators is stubborn in a state, other than a goal, if

- all that add some fact of the goal that is false there are in it;
- with an operator that is not applicable there, all that add one of its needs that is false are in it, or
  all that delete what it forbids and is true;
- with an applicable one, all are in it with which it does not commute: one takes away what the other
  needs, or adds what it forbids, or one adds what the other deletes.

It is enough to go on with the applicable ones of such a set.  Take a cheapest plan from the state, of the
fewest operators.  It contains one of the set, since it makes the goal's fact true.  The first that it
contains is applicable in the state: else the plan would have to make its need true before it, by another
of the set, which would be the first.  And it commutes with all before it, none of which is in the set: so
it can come first, in a plan of the same weight and operators.  What is left from there is again a cheapest
plan, and shorter.  So from every state a cheapest plan is found; the set depends on nothing but the state.
"""

from collections.abc import Iterable, Sequence

from verify.packed.operators import PackedOperator


class StubbornSets:
    """The stubborn sets of a problem.

    Args:
        operators: what may be done.
        facts: those that matter; others are not looked at.
        goal: facts that have to be true.
    """

    def __init__(
        self, operators: Sequence[PackedOperator], facts: frozenset[int], goal: Sequence[int]
    ) -> None:
        self._needs = [[f for f in each.pre if f in facts] for each in operators]
        self._forbids = [[f for f in each.neg if f in facts] for each in operators]
        self._adding = _by_fact((each.add for each in operators), facts)
        self._deleting = _by_fact((each.delete for each in operators), facts)
        self._needing = _by_fact((each.pre for each in operators), facts)
        self._forbidding = _by_fact((each.neg for each in operators), facts)
        self._operators, self._facts = operators, facts
        known = [fact for fact in goal if fact in facts]
        self._goal = sorted(known, key=lambda fact: self._adding[fact].bit_count())
        self._apart: dict[int, int] = {}

    def __call__(self, state: frozenset[int], applicable: Iterable[int]) -> list[int]:
        """The applicable operators of a stubborn set with few of them.

        Args:
            state: facts that are true.
            applicable: the operators that are applicable there.
        """
        ready = _bits(applicable)
        best = ready
        for fact in self._goal:
            if fact not in state:
                found = self._closed(self._adding[fact], state, ready, best.bit_count()) & ready
                if found.bit_count() < best.bit_count():
                    best = found
        return _members(best)

    def _closed(self, chosen: int, state: frozenset[int], ready: int, enough: int) -> int:
        """A stubborn set with some operators; where it gets no smaller than what there is, any set."""
        pending = chosen
        while pending:
            first = pending & ready or pending  # what is applicable shows soonest that the set gets too large
            i = (first & -first).bit_length() - 1
            pending &= ~(1 << i)
            more = (self._clashing(i) if ready >> i & 1 else self._enabling(i, state)) & ~chosen
            chosen |= more
            pending |= more
            if more and (chosen & ready).bit_count() >= enough:
                return ready
        return chosen

    def _enabling(self, i: int, state: frozenset[int]) -> int:
        """The operators of which one has to come before an operator that is not applicable."""
        ways = [self._adding[fact] for fact in self._needs[i] if fact not in state]
        ways += [self._deleting[fact] for fact in self._forbids[i] if fact in state]
        return min(ways, key=int.bit_count) if ways else -1 % (1 << len(self._operators))

    def _clashing(self, i: int) -> int:
        """The operators that an operator does not commute with."""
        if i not in self._apart:
            operator, found = self._operators[i], 0
            for fact in self._facts.intersection(operator.add):
                found |= self._deleting[fact] | self._forbidding[fact]
            for fact in self._facts.intersection(operator.delete):
                found |= self._adding[fact] | self._needing[fact]
            for fact in self._needs[i]:
                found |= self._deleting[fact]
            for fact in self._forbids[i]:
                found |= self._adding[fact]
            self._apart[i] = found & ~(1 << i)
        return self._apart[i]


def _by_fact(sets: Iterable[Sequence[int]], facts: frozenset[int]) -> dict[int, int]:
    """By fact, the operators whose set has it, as bits."""
    found = dict.fromkeys(facts, 0)
    for i, members in enumerate(sets):
        for fact in members:
            if fact in found:
                found[fact] |= 1 << i
    return found


def _bits(numbers: Iterable[int]) -> int:
    found = 0
    for number in numbers:
        found |= 1 << int(number)
    return found


def _members(bits: int) -> list[int]:
    found = []
    while bits:
        found.append((bits & -bits).bit_length() - 1)
        bits &= bits - 1
    return found
