"""Exact distances in a small transition system over sets of facts."""

from collections.abc import Iterable

from serendipity.model import Deadline
from verify.base.fact_bits import BitCondition, BitOperator, BitOperators
from verify.base.shortest_paths import dijkstra
from verify.base.undecided import UndecidedError


class BitDistances:
    """Least weights to the goal, for everything reachable from the states asked about.

    Args:
        goal: where the distance is 0.
        most: states looked at before a question is given up.
        kept: the facts that are looked at; without the others it is never farther.
    """

    def __init__(
        self,
        operators: Iterable[BitOperator],
        goal: BitCondition,
        most: int,
        deadline: Deadline,
        kept: int = -1,
    ) -> None:
        moves: dict[tuple[int, int, int, int], int] = {}
        for pre, neg, add, delete, weight, _ in deadline.each(operators):
            if (add | delete) & kept:
                move = pre & kept, neg & kept, add & kept, delete & kept
                moves[move] = min(weight, moves.get(move, weight))
        self._moves = BitOperators((BitOperator(*move, weight) for move, weight in moves.items()), deadline)
        self._goal = BitCondition(goal.pre & kept, goal.neg & kept)
        self._most, self._kept = most, kept
        self._deadline = deadline
        self._known: dict[int, int | None] = {}
        self._too_many = False

    def __call__(self, state: int) -> int | None:
        """The least weight; None if the goal can't be reached."""
        state &= self._kept
        if state not in self._known:
            self._explore(state)
        return self._known[state]

    def tabled(self, state: int) -> tuple[bool, int | None]:
        """Whether that can be said, and the least weight; once there were too many states it can't."""
        if not self._too_many:
            try:
                return True, self(state)
            except UndecidedError:
                self._too_many, self._known = True, {}
        return False, None

    def bound(self, state: int) -> int | None:
        """The same, or 0 where it can't be said."""
        known, least = self.tabled(state)
        return least if known else 0

    def _explore(self, start: int) -> None:
        before: dict[int, list[tuple[int, int]]] = {start: []}
        pending, ends = [start], []
        while pending:
            self._deadline.tick()
            state = pending.pop()
            if state in self._known:
                known = self._known[state]
                ends += [] if known is None else [(state, known)]
            elif self._goal.holds(state):
                ends.append((state, 0))
            else:
                for after, weight, _ in self._moves(state):
                    if after not in before:
                        before[after] = []
                        pending.append(after)
                    before[after].append((state, weight))
            if len(before) > self._most:
                raise UndecidedError(f"more than {self._most} states")
        found = dijkstra(ends, before.__getitem__, self._deadline)
        for state in self._deadline.each(before):
            self._known[state] = found.get(state)
