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


class GroundedCourse(NamedTuple):
    """What a ground durative action asks for and changes beside start and end; see :class:`BlockCourse`."""

    ids: tuple[Ids, ...]
    duration: Cost


class Grounded(NamedTuple):
    """One ground action; see :class:`Block`."""

    key: Key
    participants: tuple[int, ...]
    pre: Ids
    neg: Ids
    add: Ids
    delete: Ids
    cost: Cost
    course: GroundedCourse | None = None

    @property
    def only_waits(self) -> bool:
        """Whether it asks for nothing and changes nothing."""
        return not any(self[2:6]) and (self.course is None or not any(self.course.ids))


@dataclass(frozen=True, slots=True)
class BlockCourse:
    """The rest of ground durative actions.

    Attributes:
        columns: what must be true, and false, while they go on; what must be true, and false, for their
            end; what their start makes true, and false (where it does not make it true as well).
        durations: in the unit of the input, or what is wrong with them.
    """

    columns: tuple[Column, ...]
    durations: list[Cost]

    @property
    def later(self) -> tuple[tuple[Column, Column], tuple[Column, Column]]:
        """What must be true, and false, while they go on, and for their end."""
        over, over_neg, end, end_neg, _, _ = self.columns
        return (over, over_neg), (end, end_neg)

    @property
    def start_add(self) -> Column:
        """What their start makes true."""
        return self.columns[4]

    @property
    def start_delete(self) -> Column:
        """What their start makes false."""
        return self.columns[5]

    def only(self, chosen: Sequence[object]) -> "BlockCourse":
        """Those of the actions at which ``chosen`` is true."""
        columns = tuple([column.only(chosen) for column in self.columns])
        return BlockCourse(columns, [*compress(self.durations, chosen)])

    def records(self) -> Iterator[GroundedCourse]:
        """Those of the actions, one by one."""
        rows = zip(*(column.rows() for column in self.columns), strict=True)
        return map(GroundedCourse, rows, self.durations)


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
        course: the rest of durative actions; None for others.
    """

    keys: list[Key]
    participants: list[tuple[int, ...]]
    pre: Column
    neg: Column
    add: Column
    delete: Column
    costs: list[Cost]
    course: BlockCourse | None = None

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
            None if self.course is None else self.course.only(chosen),
        )

    def records(self) -> Iterator[Grounded]:
        """The actions, one by one."""
        rows = (column.rows() for column in self.conditions)
        courses = repeat(None) if self.course is None else self.course.records()
        return map(Grounded, self.keys, self.participants, *rows, self.costs, courses)

    def needs(self) -> Iterator[Ids]:
        """What has to be true at some time for each action, and is not its own doing."""
        course = self.course
        if course is None:
            return self.pre.rows()
        (over, _), (end, _) = course.later
        rows = (column.rows() for column in (self.pre, over, end, course.start_add))
        return (
            (*pre, *(fact for fact in (*inside, *last) if fact not in own))
            for pre, inside, last, own in zip(*rows, strict=True)
        )

    def gains(self) -> Iterator[Ids]:
        """What each action makes true at some time."""
        if self.course is None:
            return self.add.rows()
        return map(add_ids, self.add.rows(), self.course.start_add.rows())

    @property
    def asked(self) -> tuple[Column, ...]:
        """All conditions."""
        course = self.course
        return (self.pre, self.neg) if course is None else (self.pre, self.neg, *course.columns[:4])

    @property
    def added(self) -> tuple[Column, ...]:
        """All that becomes true."""
        return (self.add,) if self.course is None else (self.add, self.course.start_add)

    @property
    def deleted(self) -> tuple[Column, ...]:
        """All that becomes false."""
        return (self.delete,) if self.course is None else (self.delete, self.course.start_delete)


def facts_of(columns: Iterable[Column]) -> Iterator[int]:
    """Every id that occurs in some columns, in any order, not only once."""
    return chain.from_iterable(column.facts() for column in columns)


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
        _course_of([record.course for record in records if record.course is not None]),
    )


def _course_of(courses: Sequence[GroundedCourse]) -> BlockCourse | None:
    if not courses:
        return None
    everything = range(len(courses))
    columns = tuple([Column([course.ids[i] for course in courses], everything) for i in range(6)])
    return BlockCourse(columns, [course.duration for course in courses])
