"""A robot's own states, where things that are alike can be exchanged: few, whatever the number of things.

A thing that a state no longer speaks of is forgotten; whether the robot has seen to it is told by counters
alone.  So it may come to it as if for the first time: a robot then counts too much, never too little.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from search.short_windows.independent.alike.tally import Tally
from search.short_windows.independent.provision import Value
from search.short_windows.independent.timeline import TooManyStatesError
from search.packed.operators import Operator, applicable, split
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline

MOST_PLACES: Final = 3_000
"""States of a robot's own, up to exchanging things."""


class Place(NamedTuple):
    """A state of a robot's own.

    Attributes:
        state: its fields, packed.
        seen_to: the counted fields of things that the state speaks of and that the robot has set.
    """

    state: int
    seen_to: frozenset[int]


class Edge(NamedTuple):
    """What a robot can do.

    Attributes:
        target: the block of places that it leads to.
        counts: the counters that go up.
        amount: what it costs.
    """

    target: int
    counts: tuple[int, ...]
    amount: int


class Robot:
    """A robot's places, those together from which the same can be done, and what leads from each to which.

    Args:
        packed: the packed task.
        ops: the robot's operators, with what each costs.
        tally: how what robots do is counted.
        deadline: polled.

    Attributes:
        edges: by block what can be done; the robot starts in block 0.

    Raises:
        LimitReachedError: there are too many places, or the deadline came.
    """

    def __init__(
        self,
        packed: PackedTask,
        ops: Sequence[tuple[Operator, int]],
        tally: Tally,
        deadline: Deadline,
    ) -> None:
        self._tally = tally
        self._things = tally.things
        self._deadline = deadline
        self._counted = sum(tally.counter_of)
        self._value = {field: value for counter in tally.counters for field, value in counter.values}
        self._names = {field: tally.things.mentioned[field, value] for field, value in self._value.items()}
        self._ops = ops
        mask = 0
        for op, _ in ops:
            mask |= packed.mentioned(op)
        self._mask = mask & ~tally.fields
        self._fields = [field for field in packed.fields if field & self._mask]
        self._moves = _Moves(ops, self._fields)
        self._short: dict[tuple[Value, tuple[tuple[str, str], ...]], Value] = {}
        self._first: dict[Place, Place] = {}
        self.start = Place(packed.init & self._mask, frozenset())
        found, edges = self._explored()
        self._number = found
        self._block = _blocks(edges, deadline)
        self.edges: list[list[Edge]] = [[] for _ in range(max(self._block) + 1)]
        for place, leading in enumerate(edges):
            known = self.edges[self._block[place]]
            if not known:
                targets = {edge._replace(target=self._block[edge.target]) for edge in leading}
                known += sorted(targets)

    def _explored(self) -> tuple[dict[Place, int], list[set[Edge]]]:
        number = {self._exchanged(self.start): 0}
        queue, edges = list(number), list[set[Edge]]()
        for place in queue:
            self._deadline.check()
            leading = set()
            for op, amount in self.able(place.state):
                after, counts = self.after(place, op)
                target = self._exchanged(after)
                if target not in number:
                    if len(number) == MOST_PLACES:
                        raise TooManyStatesError
                    number[target] = len(number)
                    queue.append(target)
                leading.add(Edge(number[target], counts, amount))
            edges.append(leading)
        return number, edges

    def able(self, state: int) -> Iterator[tuple[Operator, int]]:
        """What the robot can do in a state of its own, with what it costs."""
        return self._moves.of(state)

    def after(self, place: Place, op: Operator) -> tuple[Place, tuple[int, ...]]:
        """The place after an operator, with what it speaks of, and the counters that went up."""
        sets = set(split(self._counted & ~op.keep, self._things.fields))
        counts = tuple(sorted(self._tally.counter_of[field] for field in sets - place.seen_to))
        return Place(place.state & op.keep | op.put & self._mask, place.seen_to | sets), counts

    def block(self, place: Place) -> int | None:
        """The block of a place; None where it is none of those that come about when things are forgotten."""
        number = self._number.get(self._exchanged(place))
        return None if number is None else self._block[number]

    def speaks_of(self, state: int) -> list[str]:
        """The things of some kind in a state, in the order of its fields."""
        found: list[str] = []
        for field in self._fields:
            names = self._things.mentioned.get((field, state & field), ())
            found += sorted(name for name in names if name in self._tally.kinds and name not in found)
        return found

    def counted_in(self, state: int) -> set[int]:
        """The counted fields of the things that a state of the robot's own speaks of."""
        names = set(self.speaks_of(state))
        return {field for field, spoken in self._names.items() if spoken & names}

    def _exchanged(self, place: Place) -> Place:
        """The same place with the first things of each kind, and without those that it does not speak of."""
        found = self._first.get(place)
        if found is None:
            found = self._first[place] = self._with_first_things(place)
        return found

    def _with_first_things(self, place: Place) -> Place:
        spoken = self.speaks_of(place.state)
        taken: dict[int, int] = defaultdict(int)
        names = {}
        for name in spoken:
            kind = self._tally.kinds[name]
            names[name] = self._tally.names[kind][taken[kind]]
            taken[kind] += 1
        renaming = tuple(names.items())
        state = 0
        for field in self._fields:
            state |= self._renamed((field, place.state & field), renaming)[1]
        seen_to = frozenset(
            self._renamed((field, self._value[field]), renaming)[0]
            for field in place.seen_to
            if self._names[field] & names.keys()
        )
        return Place(state, seen_to)

    def _renamed(self, value: Value, renaming: tuple[tuple[str, str], ...]) -> Value:
        if not renaming:
            return value
        known = self._short.get((value, renaming))
        if known is None:
            names = dict(renaming)
            back = {new: old for old, new in renaming if new not in names}
            renamed = self._things.renamed(value, {**back, **names})
            assert renamed is not None, "things of a kind can be exchanged"
            known = self._short[value, renaming] = renamed
        return known


class _Moves:
    """A robot's operators by the value of the field that most of them ask for."""

    def __init__(self, ops: Sequence[tuple[Operator, int]], fields: Sequence[int]) -> None:
        self._field = max(
            fields, key=lambda field: sum(bool(op.need_mask & field) for op, _ in ops), default=0
        )
        self._by_value: dict[int, list[tuple[Operator, int]]] = defaultdict(list)
        self._others: list[tuple[Operator, int]] = []
        for op, amount in ops:
            if op.need_mask & self._field:
                self._by_value[op.need & self._field].append((op, amount))
            else:
                self._others.append((op, amount))

    def of(self, state: int) -> Iterator[tuple[Operator, int]]:
        for ops in (self._by_value.get(state & self._field, ()), self._others):
            for op, amount in ops:
                if applicable(op, state):
                    yield op, amount


def _blocks(edges: Sequence[set[Edge]], deadline: Deadline) -> list[int]:
    """By place the number of those from which the same can be counted at the same cost; the first has 0."""
    block, size = [0] * len(edges), 1
    while True:
        deadline.check()
        numbers: dict[tuple[int, frozenset[tuple[int, tuple[int, ...], int]]], int] = {}
        block = [
            numbers.setdefault(
                (block[place], frozenset((block[edge.target], edge.counts, edge.amount) for edge in leading)),
                len(numbers),
            )
            for place, leading in enumerate(edges)
        ]
        if len(numbers) == size:
            return block
        size = len(numbers)
