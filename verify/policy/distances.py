"""Exact distances in a small transition system over bit sets of facts."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

from serendipity.model import Deadline
from verify.base.shortest_paths import PathSearch, dijkstra
from verify.base.undecided import UndecidedError


@dataclass(frozen=True, slots=True)
class GameEdge:
    """An action over bit sets of facts: needs ``pre``, excludes ``neg``, sets and unsets."""

    pre: int
    neg: int
    add: int
    delete: int
    weight: int
    action: int
    """Its id in the task."""

    def applicable(self, state: int) -> bool:
        """Whether it can be done in a state."""
        return state & self.pre == self.pre and not state & self.neg

    def after(self, state: int) -> int:
        """The state that it leads to."""
        return state & ~self.delete | self.add


@dataclass(frozen=True, slots=True)
class PackedCondition:
    """Facts that must hold, and that must not."""

    pre: int
    neg: int

    def holds(self, state: int) -> bool:
        """Whether they do."""
        return state & self.pre == self.pre and not state & self.neg


class Moves:
    """Applicable edges of a state, looked up under one fact that each of them needs."""

    def __init__(self, edges: Sequence[GameEdge], deadline: Deadline) -> None:
        count: dict[int, int] = {}
        for edge in deadline.each(edges):
            for bit in bits_of(edge.pre):
                count[bit] = count.get(bit, 0) + 1
        self._under: dict[int, list[GameEdge]] = {}
        self._always: list[GameEdge] = []
        self._watched = 0
        for edge in deadline.each(edges):
            bit = min(bits_of(edge.pre), key=lambda bit: count[bit], default=0)
            self._under.setdefault(bit, []).append(edge) if bit else self._always.append(edge)
            self._watched |= bit

    def __call__(self, state: int) -> Iterator[tuple[int, int, int]]:
        """For each edge that is applicable the state after it, its weight and its action."""
        under = self._under
        for edge in chain(self._always, *(under[bit] for bit in bits_of(state & self._watched))):
            if state & edge.pre == edge.pre and not state & edge.neg:
                yield state & ~edge.delete | edge.add, edge.weight, edge.action


def bits_of(mask: int) -> Iterator[int]:
    """The single bits of a mask, ascending."""
    while mask:
        bit = mask & -mask
        yield bit
        mask ^= bit


class GameDistances:
    """Least weights to the goal, for everything reachable from the states asked about.

    Args:
        edges: the actions.
        goal: where the distance is 0.
        most: states looked at before a question is given up.
        deadline: polled.
    """

    def __init__(
        self, edges: Sequence[GameEdge], goal: PackedCondition, most: int, deadline: Deadline
    ) -> None:
        self._moves = Moves(edges, deadline)
        self._goal = goal
        self._most = most
        self._deadline = deadline
        self._known: dict[int, int | None] = {}

    def __call__(self, state: int) -> int | None:
        """The least weight; None if the goal can't be reached.

        Raises:
            UndecidedError: there are too many states.
            LimitReachedError: the deadline came first.
        """
        if state not in self._known:
            self._explore(state)
        return self._known[state]

    def _explore(self, start: int) -> None:
        before: dict[int, list[tuple[int, int]]] = {start: []}
        pending, ends = [start], []
        while pending:
            self._deadline.check()
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


def reaches_below(
    moves: Moves,
    goal: PackedCondition,
    start: int,
    limit: int,
    least: Callable[[int], int],
    most: int,
    deadline: Deadline,
) -> bool | None:
    """Whether the goal can be reached from ``start`` for less than ``limit``; None if that takes too long.

    Args:
        moves: the actions.
        goal: the goal.
        start: the state.
        limit: what must be undercut.
        least: a consistent lower bound on what a state still takes.
        most: states looked at before giving up.
        deadline: polled.

    Raises:
        LimitReachedError: the deadline came first.
    """
    for looked_at, (state, _) in enumerate(PathSearch(start, moves, least, deadline, limit)):
        if goal.holds(state):
            return True
        if looked_at >= most:
            return None
    return False
