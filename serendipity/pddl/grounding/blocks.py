"""Ground actions column by column: at 100,000 of them, each object that many share counts."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, compress
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
    pre: Ids
    neg: Ids
    add: Ids
    delete: Ids
    cost: Cost


@dataclass(frozen=True, slots=True)
class Block:
    """Ground actions, with ids that are neither sorted nor final.

    Attributes:
        keys: names, ``(name, arguments...)``.
        participants: agent ids.
        pre: what must be true.
        neg: what must be false.
        add: what they make true.
        delete: what they make false, where they don't make it true as well.
        costs: undiscounted, or what is wrong with them.
    """

    keys: list[Key]
    participants: list[tuple[int, ...]]
    pre: Column
    neg: Column
    add: Column
    delete: Column
    costs: list[Cost]

    def __len__(self) -> int:
        return len(self.keys)

    @property
    def conditions(self) -> tuple[Column, Column, Column, Column]:
        """Preconditions and effects."""
        return self.pre, self.neg, self.add, self.delete

    def only(self, chosen: Sequence[object]) -> "Block":
        """The actions at which ``chosen`` is true."""
        if all(chosen):
            return self
        return Block(
            [*compress(self.keys, chosen)],
            [*compress(self.participants, chosen)],
            self.pre.only(chosen),
            self.neg.only(chosen),
            self.add.only(chosen),
            self.delete.only(chosen),
            [*compress(self.costs, chosen)],
        )

    def records(self) -> Iterator[Grounded]:
        """The actions, one by one."""
        rows = (column.rows() for column in self.conditions)
        return map(Grounded, self.keys, self.participants, *rows, self.costs)


def block_of(records: Sequence[Grounded]) -> Block:
    """The block of some actions: what :meth:`Block.records` gives back."""
    everything = range(len(records))
    return Block(
        [record.key for record in records],
        [record.participants for record in records],
        Column([record.pre for record in records], everything),
        Column([record.neg for record in records], everything),
        Column([record.add for record in records], everything),
        Column([record.delete for record in records], everything),
        [record.cost for record in records],
    )
