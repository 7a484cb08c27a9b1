"""Ground actions column by column: at 100,000 of them, each object that many share counts."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, compress, repeat
from operator import add as add_ids
from typing import NamedTuple

from serendipity.pddl.grounding.costs import Cost
from serendipity.pddl.parsing.lifted import Key

Ids = tuple[int, ...]
"""Fact ids."""


class Column(NamedTuple):
    """Some fact ids of each action: ``table[places[i]]`` are those of action ``i``."""

    table: list[Ids]
    places: Sequence[int]

    def rows(self) -> Iterator[Ids]:
        """The ids, action by action."""
        return map(self.table.__getitem__, self.places)

    def facts(self) -> Iterator[int]:
        """Every id that occurs, in any order, not only once."""
        return chain.from_iterable(map(self.table.__getitem__, {*self.places}))

    def only(self, chosen: Sequence[object]) -> "Column":
        """The column of the actions at which ``chosen`` is true."""
        return Column(self.table, [*compress(self.places, chosen)])


class Grounded(NamedTuple):
    """One ground action; see :class:`Block`."""

    key: Key
    participants: tuple[int, ...]
    ids: tuple[Ids, ...]
    cost: Cost
    duration: Cost | None = None

    @property
    def only_waits(self) -> bool:
        """Whether it asks for nothing and changes nothing."""
        return not any(self.ids)


@dataclass(frozen=True, slots=True)
class Block:
    """Ground actions, with ids that are neither sorted nor final.

    Attributes:
        keys: names, ``(name, arguments...)``.
        columns: what must be true, must be false, becomes true, and becomes false (where it does not become
            true as well); of durative actions these are of their start and end, and there are six more: what
            must be true, and false, while they go on, and for their end; what their start makes true, and
            false.  So every other column is of what is or becomes false.
        costs: undiscounted, or what is wrong with them.
        durations: of durative actions, in the unit of the input, or what is wrong with them; else None.
    """

    keys: list[Key]
    participants: list[tuple[int, ...]]
    columns: tuple[Column, ...]
    costs: list[Cost]
    durations: list[Cost] | None = None

    def __len__(self) -> int:
        return len(self.keys)

    def only(self, chosen: Sequence[object]) -> "Block":
        """The actions at which ``chosen`` is true."""
        if all(chosen):
            return self
        return Block(
            [*compress(self.keys, chosen)],
            [*compress(self.participants, chosen)],
            tuple([column.only(chosen) for column in self.columns]),
            [*compress(self.costs, chosen)],
            None if self.durations is None else [*compress(self.durations, chosen)],
        )

    def records(self) -> Iterator[Grounded]:
        """The actions, one by one."""
        rows = zip(*(column.rows() for column in self.columns), strict=True)
        durations = repeat(None) if self.durations is None else self.durations
        return map(Grounded, self.keys, self.participants, rows, self.costs, durations)

    def needs(self) -> Iterator[Ids]:
        """What has to be true at some time for each action, and is not its own doing."""
        if self.durations is None:
            return self.columns[0].rows()
        rows = (self.columns[i].rows() for i in (0, 4, 6, 8))
        return (
            (*pre, *(fact for fact in (*inside, *last) if fact not in own))
            for pre, inside, last, own in zip(*rows, strict=True)
        )

    def gains(self) -> Iterator[Ids]:
        """What each action makes true at some time."""
        first, *more = (column.rows() for column in self.added)
        return map(add_ids, first, *more) if more else first

    @property
    def conditions(self) -> tuple[tuple[Column, Column], ...]:
        """What must be true, and false, at each time that something is asked."""
        asked = self.asked
        return tuple(zip(asked[::2], asked[1::2], strict=True))

    @property
    def asked(self) -> tuple[Column, ...]:
        """All conditions."""
        return (*self.columns[:2], *self.columns[4:8])

    @property
    def added(self) -> tuple[Column, ...]:
        """All that becomes true."""
        return self.columns[2::6]

    @property
    def deleted(self) -> tuple[Column, ...]:
        """All that becomes false."""
        return self.columns[3::6]


def facts_of(columns: Iterable[Column]) -> Iterator[int]:
    """Every id that occurs in some columns, in any order, not only once."""
    return chain.from_iterable(column.facts() for column in columns)


def block_of(records: Sequence[Grounded]) -> Block:
    """The block of some actions, all or none of them durative: what :meth:`Block.records` gives back."""
    everything = range(len(records))
    durations = [record.duration for record in records if record.duration is not None]
    columns = zip(*(record.ids for record in records), strict=True)
    return Block(
        [record.key for record in records],
        [record.participants for record in records],
        tuple([Column([*rows], everything) for rows in columns]),
        [record.cost for record in records],
        durations or None,
    )
