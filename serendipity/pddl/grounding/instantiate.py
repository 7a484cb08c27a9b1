"""Lifted actions to ground actions: names, fact ids, costs.

Columns of them are built by C loops (``map``, ``zip``): at 100,000 actions a Python loop
for each would cost seconds.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import chain, count
from typing import Final

from serendipity.model.errors import LIMITS
from serendipity.pddl.grounding.blocks import Block, Column, Grounded, Ids, block_of
from serendipity.pddl.grounding.cases import Cases
from serendipity.pddl.grounding.costs import Costs
from serendipity.pddl.grounding.join import Relations, bindings
from serendipity.pddl.grounding.normal import Lifted, lifted_of
from serendipity.pddl.grounding.product import Product
from serendipity.pddl.grounding.quantifiers import ground_key
from serendipity.pddl.parsing.lifted import Key, Literal, Schema, Unit
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.work import Work, about

Participants = Callable[[Sequence[Key]], Iterable[tuple[int, ...]]]
"""From ground names ``(name, arguments...)`` to the ids of the agents that take part."""

BYTES: Final = 300
"""Of a ground action in a block, without what it asks for and changes; measured."""

_BYTES_PER_FACT: Final = 8

_SLICE: Final = 50_000
"""Fact ids, arguments and the like in ground actions that are made at once: some milliseconds of them.

Nobody need ask memory for so many.
"""

_LARGE: Final = 5_000
"""Ground actions of a block that is made of single ones."""


class Instantiator:
    """Grounds schemas over one united initial state; facts get ids in the order of first use."""

    def __init__(self, relations: Relations, values: dict[Key, Fraction], work: Work) -> None:
        self.relations = relations
        self.work = work
        self._costs = Costs(values)
        self.facts: defaultdict[Key, int] = defaultdict(count().__next__)
        self._blocks: list[Block] = []
        self._records: list[Grounded] = []
        self._durative: list[Grounded] = []
        self._count = 0

    def ground(
        self,
        schema: Schema,
        unit: Unit,
        participants: Participants,
        actors: frozenset[str] | None = None,
    ) -> None:
        """Make a schema's ground actions with static preconditions that hold, of those actors if given."""
        try:
            lifted = lifted_of(schema, unit, self.work)
            product = bindings(lifted, unit, self.relations, self.work, actors)
        except LIMITS:
            name = quoted(schema.name)
            self.work.doing = f"grounding action {name}, {self._count:,} ground actions so far"
            raise
        if lifted.choices:  # static ones have been decided
            open_ = tuple(c for c in lifted.choices if not self.relations.static(c))
            lifted = replace(lifted, choices=open_)
        size = 10 + len(lifted.precondition) + len(lifted.effects) + len(lifted.conditional)
        if product.size * size <= _SLICE:
            self._ground(lifted, unit, participants, product)
            return
        what = f"reading {unit.place(schema)} comes to {about(product.size)} ground actions"
        self.work.require(product.size * (BYTES + _BYTES_PER_FACT * size), what)
        for part in product.slices(max(1, _SLICE // size)):
            self._ground(lifted, unit, participants, part)

    def _tell(self, more: int) -> None:
        before, self._count = self._count, self._count + more
        if not before or before // _LARGE < self._count // _LARGE:
            self.work.stage(f"grounding, {self._count:,} ground actions so far")

    def _ground(self, lifted: Lifted, unit: Unit, participants: Participants, product: Product) -> None:
        self._tell(product.size)
        if lifted.conditional or lifted.choices:
            cases = Cases(lifted, unit, self.relations, self.facts, self.work)
            records = self._block(lifted, unit, participants, product).records()
            for record in self.work.deadline.each(cases.expanded(records, product)):
                self._add(record)
        elif product.everything:
            self._blocks.append(self._block(lifted, unit, participants, product))
        elif product.size:  # in files that are ground already, there is nothing else
            self._add(self._record(lifted, unit, participants, product))

    def _add(self, record: Grounded) -> None:
        records = self._records if record.duration is None else self._durative
        records.append(record)
        if len(records) >= _LARGE:
            self._make_block(records)

    def _make_block(self, records: list[Grounded]) -> None:
        self._blocks.append(block_of(records))
        records.clear()
        self.work.require(_LARGE * BYTES, f"grounding cases, {self._count:,} ground actions so far")

    def blocks(self) -> list[Block]:
        """All ground actions so far."""
        return [*self._blocks, *(block_of(some) for some in (self._records, self._durative) if some)]

    def _block(self, lifted: Lifted, unit: Unit, participants: Participants, product: Product) -> Block:
        atoms = _Atoms(product, self.facts)
        keys = atoms.of(schema_key(lifted), product.everything)
        columns = tuple(map(atoms.column, self._parts(lifted)))
        costs = self._costs.of(lifted.schema, unit, product)
        durations = self._costs.durations(lifted.schema, unit, product) if lifted.schema.course else None
        return Block(keys, [*participants(keys)], columns, costs, durations)

    def _record(self, lifted: Lifted, unit: Unit, participants: Participants, product: Product) -> Grounded:
        values = product.fixed
        key = ground_key(schema_key(lifted), values)
        ids = tuple(
            [tuple([self.facts[ground_key(atom, values)] for atom in atoms]) for atoms in self._parts(lifted)]
        )
        (who,) = participants([key])
        (cost,) = self._costs.of(lifted.schema, unit, product)
        durations = self._costs.durations(lifted.schema, unit, product) if lifted.schema.course else [None]
        return Grounded(key, who, ids, cost, *durations)

    def _parts(self, lifted: Lifted) -> tuple[list[Key], ...]:
        """The lifted atoms of each column of a block."""
        found = (*self._fluent(lifted.precondition), *_by_sign(lifted.effects))
        if lifted.schema.course is None:
            return found
        over, end = self._fluent(lifted.over_all), self._fluent(lifted.at_end)
        return (*found, *over, *end, *_by_sign(lifted.start_effects))

    def _fluent(self, needs: Iterable[Literal]) -> tuple[list[Key], list[Key]]:
        return _by_sign([literal for literal in needs if literal.key[0] in self.relations.fluent])


def _by_sign(literals: Sequence[Literal]) -> tuple[list[Key], list[Key]]:
    """The atoms of the positive literals, and of the others."""
    return (
        [literal.key for literal in literals if literal.positive],
        [literal.key for literal in literals if not literal.positive],
    )


class _Atoms:
    """Ground atoms of lifted ones, for all bindings at once."""

    def __init__(self, product: Product, facts: dict[Key, int]) -> None:
        self.product = product
        self.facts = facts
        self._ids: dict[Key, list[int]] = {}

    def of(self, lifted: Key, part: tuple[int, ...]) -> list[Key]:
        """The ground atoms of one atom, for each binding of the part that it depends on."""
        head, *terms = lifted
        columns = [self.product.column(term, part) for term in (head, *terms)]
        return list(zip(*columns, strict=True))

    def column(self, lifted: Sequence[Key]) -> Column:
        """The fact ids of some atoms."""
        part = self.product.part(chain.from_iterable(lifted))
        spread = [self._spread(key, part) for key in lifted]
        table: list[Ids] = [*zip(*spread, strict=True)] if lifted else [()]
        return Column(table, self.product.index(part, self.product.everything))

    def _spread(self, key: Key, whole: tuple[int, ...]) -> Iterator[int]:
        part = self.product.part(key)
        ids = self._ids.get(key)
        if ids is None:
            ids = self._ids[key] = [*map(self.facts.__getitem__, self.of(key, part))]
        return map(ids.__getitem__, self.product.index(part, whole))


def schema_key(lifted: Lifted) -> Key:
    """The lifted name of a lifted action's actions: name, declared parameters."""
    return (lifted.schema.name, *(p.name for p in lifted.schema.parameters))
