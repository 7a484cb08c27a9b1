"""Final ids: facts that matter in the order of their names, actions in that of theirs."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, repeat
from operator import attrgetter

from serendipity.model import Condition, GroundAction
from serendipity.pddl.blocks import Block, Column
from serendipity.pddl.lifted import Key, Literal


class Numbering:
    """The facts of a task in their final order, and what is made of them.

    Args:
        facts: ids of ground atoms, in ascending order.
        init: ids of those that are true initially.
        blocks: the actions that can be executed.
        goals: ids of atoms that goals name; they stay facts in any case.

    Attributes:
        names: of the facts that matter, ascending.
    """

    def __init__(
        self, facts: Mapping[Key, int], init: set[int], blocks: Sequence[Block], goals: Iterable[int]
    ) -> None:
        added = set(chain.from_iterable(block.add.facts() for block in blocks))
        deleted = set(chain.from_iterable(block.delete.facts() for block in blocks))
        always = init - deleted
        never = set(range(len(facts))) - init - added
        relevant = added | deleted
        for block in blocks:
            relevant.update(block.pre.facts(), block.neg.facts())
        relevant -= always | (never - deleted)
        relevant.update(goals)
        keys = list(facts)
        named = {" ".join(keys[old]): old for old in relevant}
        self.names = tuple(sorted(named))
        self.facts = facts
        self.blocks = blocks
        self._ids = {named[name]: new for new, name in enumerate(self.names)}
        self._changing = {old: new for old, new in self._ids.items() if old not in always}
        self._possible = {old: new for old, new in self._ids.items() if old not in never}
        self.init = frozenset(self._ids[old] for old in init if old in self._ids)

    def condition(self, literals: Sequence[Literal]) -> Condition:
        """The condition that some literals make up."""
        return Condition(
            tuple(sorted({self._ids[self.facts[lit.key]] for lit in literals if lit.positive})),
            tuple(sorted({self._ids[self.facts[lit.key]] for lit in literals if not lit.positive})),
        )

    def actions(self) -> list[GroundAction]:
        """The actions without noops, ascending in name, then in all the rest; each once.

        A blank is less than any character of a word, so this is the order of ``key``.
        """
        actions = [*chain.from_iterable(map(self._ground, self.blocks))]
        if len({action.name for action in actions}) == len(actions):
            return sorted(actions, key=attrgetter("name"))
        return sorted(set(actions), key=attrgetter(*GroundAction.__slots__))

    def _ground(self, block: Block) -> Iterator[GroundAction]:
        add = _renumbered(block.add, self._changing)
        block = Block(
            block.keys,
            block.participants,
            _renumbered(block.pre, self._changing),
            _renumbered(block.neg, self._possible),
            add,
            _without(_renumbered(block.delete, self._ids), add),
            block.costs,
        )
        if all(() in column.table for column in block.conditions):
            block = block.only([any(record[2:6]) for record in block.records()])
        columns = [column.rows() for column in block.conditions]
        return map(GroundAction, map(" ".join, block.keys), block.participants, *columns, block.costs)


def _renumbered(column: Column, ids: Mapping[int, int]) -> Column:
    """The facts that have new ids, ascending."""
    rows: Iterable[Iterable[int]]
    if ids.keys() >= {*chain.from_iterable(column.table)}:
        rows = map(map, repeat(ids.__getitem__), column.table)
    else:
        rows = [[ids[fact] for fact in row if fact in ids] for row in column.table]
    return Column([*map(tuple, map(sorted, map(set, rows)))], column.places)


def _without(deleted: Column, added: Column) -> Column:
    """What is deleted and not added at the same time."""
    if {*deleted.facts()}.isdisjoint(added.facts()):
        return deleted
    pairs = [*zip(deleted.places, added.places, strict=True)]
    places = {pair: place for place, pair in enumerate(dict.fromkeys(pairs))}
    table = [tuple([fact for fact in deleted.table[d] if fact not in added.table[a]]) for d, a in places]
    return Column(table, [places[pair] for pair in pairs])
