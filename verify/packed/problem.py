"""One goal, many questions: layout, operators and bounds that all of them share."""

from collections.abc import Iterable, Sequence

import numpy as np

from serendipity.model import Deadline
from verify.limits import limits
from verify.packed.bounds import PatternBounds
from verify.packed.cheapest_path import PackedSearch, SumTooLargeError, TooManyPackedStatesError
from verify.packed.layout import Effects, Ints, PackedLayout, Words
from verify.packed.mutexes import ReachablePairs, exclusive_groups
from verify.packed.operators import OperatorTable, PackedOperator


class TooLargeError(Exception):
    """A problem that packed states are not made for."""


class StateSpace:
    """The facts that may be true together, and layouts for them.

    Args:
        actions: all that may ever happen, circles of actions that happen at once included.

    Raises:
        TooLargeError: there are too many facts or actions.
    """

    def __init__(
        self, facts: int, init: frozenset[int], actions: Sequence[Effects], deadline: Deadline
    ) -> None:
        if facts > limits().packed_facts or len(actions) > limits().packed_actions:
            raise TooLargeError
        self._deadline = deadline
        self.pairs = ReachablePairs(facts, init, actions, deadline)
        self.actions = [action for action in deadline.each(actions) if self.pairs.possible(action.pre)]

    def layout(self, facts: Iterable[int]) -> PackedLayout:
        """Fields for some facts: the largest groups of which no two are true together."""
        facts = tuple(facts)
        return PackedLayout(facts, exclusive_groups(self.pairs, facts, self._deadline), self.actions)


class PackedProblem:
    """Cheapest ways to a goal, from any states that can be reached.

    Args:
        facts: that operators and goal look at.
        bounded: whether lower bounds spare the search states; else it looks at all that cost little enough.
        exact: weights may add up to any sum: they are Python's integers, and there are no bounds.

    Raises:
        TooLargeError: weights may add up to more than a word holds.
    """

    def __init__(
        self,
        space: StateSpace,
        facts: Iterable[int],
        operators: Sequence[PackedOperator],
        goal: tuple[Sequence[int], Sequence[int]],
        deadline: Deadline,
        *,
        bounded: bool = True,
        exact: bool = False,
    ) -> None:
        operators = [each for each in operators if space.pairs.possible(each.pre)]
        if not exact and sum(operator.weight for operator in operators) > limits().weight:
            raise TooLargeError
        self._space, self._deadline = space, deadline
        self.layout = space.layout(facts)
        self.table = OperatorTable(self.layout, operators, exact=exact)
        self._wanted = tuple(goal[0])
        self.goal = self.table.test(*goal)
        self._bounds: PatternBounds | None = None
        self.exact, self.bounded = exact, bounded and not exact
        self._careful = not self.bounded

    def pack(self, states: Sequence[frozenset[int]]) -> Words | None:
        """States as rows; None if one of them can't be reached."""
        if not all(self._space.pairs.possible(state) for state in states):
            return None
        return self.layout.pack(states)

    def search(self, starts: Words, paid: Ints, below: int | None = None) -> tuple[PackedSearch, int | None]:
        """A search from some states with what was paid so far, and the goal state that it ends in.

        Args:
            below: paths of this weight or more don't count; None: all do.

        Returns:
            The search, and the state's number in it; None: there is no way for less than ``below``.

        Raises:
            TooManyPackedStatesError: there are more than memory should hold, or weights too large to tell.
        """
        if self.exact:
            return self._searched(starts, paid, self.table.far if below is None else below)
        most = limits().weight
        search, found = self._searched(starts, paid, most if below is None else min(below, most))
        if found is None and (below is None or below > most) and self._may_pass(most, search):
            raise SumTooLargeError("costs are too large to be added up in machine words")
        return search, found

    def _may_pass(self, most: int, search: PackedSearch) -> bool:
        """True if anything may have been left out because it weighs more than a word should hold.

        A cheapest path goes through no state twice, neither here nor in the pattern of a bound.
        """
        states = search.states + (0 if self._bounds is None else self._bounds.states)
        return int(self.table.weight.max(initial=0)) * states > most

    def _searched(self, starts: Words, paid: Ints, below: int) -> tuple[PackedSearch, int | None]:
        if self._bounds is None and self.bounded:
            self._bounds = self._made()
        if not self._careful:
            search = self._search(below, limits().few_states)
            try:
                search.add(starts, paid)
                return search, search.run()
            except TooManyPackedStatesError:
                self._bounds, self._careful = self._made(careful=True), True
        search = self._search(below, limits().exact_states if self.exact else limits().packed_states)
        search.add(starts, paid)
        return search, search.run()

    def least(self, start: Words, below: int | None = None) -> int | None:
        """The least weight from one state to the goal; None if there is no way for less than ``below``."""
        search, reached = self.search(start, np.zeros(1, np.int64), below)
        return None if reached is None else search.paid(reached)

    def bounds(self, states: Words) -> Ints:
        """Lower bounds on what is left; 0 where there are to be none."""
        if not self.bounded:
            return np.zeros(len(states), np.int64)
        if self._bounds is None:
            self._bounds = self._made()
        return self._bounds(states)

    def _search(self, below: int, most_states: int) -> PackedSearch:
        return PackedSearch(self.table, self.goal, self.bounds, self._deadline, below, most_states)

    def _made(self, *, careful: bool = False) -> PatternBounds:
        return PatternBounds(self.table, self._wanted, self._deadline, careful=careful)
