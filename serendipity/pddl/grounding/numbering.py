"""Final ids: facts that matter in the order of their names, actions in that of theirs."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from fractions import Fraction
from itertools import chain, repeat
from operator import attrgetter
from typing import cast

from serendipity.model import Condition, GroundAction, TimedFact
from serendipity.pddl.grounding.blocks import Block, Column, facts_of
from serendipity.pddl.grounding.clock import timed_action
from serendipity.pddl.grounding.costs import BadCost, Cost
from serendipity.pddl.parsing.lifted import Key, Literal
from serendipity.pddl.work import Work


class Changes:
    """The facts that executable actions change.

    Args:
        facts: ids of ground atoms, in ascending order.
        init: ids of those that are true initially.
        script: ids of those that become true, and false, anyway.

    Attributes:
        always: facts that are true in every state.
        never: facts that are true in none.
        relevant: facts that are neither, or that some action asks for or deletes.
    """

    def __init__(
        self,
        facts: Mapping[Key, int],
        init: set[int],
        blocks: Sequence[Block],
        work: Work,
        script: tuple[AbstractSet[int], AbstractSet[int]] = (frozenset(), frozenset()),
    ) -> None:
        added, deleted = map(set, script)
        asked: set[int] = set()
        for block in work.deadline.each(blocks, 1):
            added.update(facts_of(block.added))
            deleted.update(facts_of(block.deleted))
            asked.update(facts_of(block.asked))
        self.always = init - deleted
        self.never = set(range(len(facts))) - init - added
        self.relevant = (added | deleted | asked) - self.always - (self.never - deleted)

    def truth(self, fact: int, positive: bool) -> bool | None:
        """The truth of a literal if it is the same in every state."""
        if fact in self.always:
            return positive
        return not positive if fact in self.never else None


class Numbering:
    """The facts of a task in their final order, and what is made of them.

    Args:
        facts: ids of ground atoms, in ascending order.
        goals: ids of atoms that goals name; they stay facts in any case.

    Attributes:
        names: of the facts that matter, ascending.
        init: ids of those that are true initially.
        waiting: names of the actions that only wait, each with the agent who does.
    """

    def __init__(
        self,
        facts: Mapping[Key, int],
        init: set[int],
        blocks: Sequence[Block],
        changes: Changes,
        goals: Iterable[int],
        work: Work,
    ) -> None:
        keys = list(facts)
        named = {" ".join(keys[old]): old for old in work.deadline.each(changes.relevant.union(goals))}
        self.names = tuple(sorted(named))
        self.facts = facts
        self.blocks = blocks
        self.waiting: set[tuple[str, int]] = set()
        self._work = work
        self._ids = {named[name]: new for new, name in enumerate(self.names)}
        self._changing = {old: new for old, new in self._ids.items() if old not in changes.always}
        self._possible = {old: new for old, new in self._ids.items() if old not in changes.never}
        self.init = frozenset(self._ids[old] for old in init if old in self._ids)

    def literal(self, literal: Literal) -> tuple[int, bool]:
        """The final id of a literal's fact, and whether it is positive."""
        return self._ids[self.facts[literal.key]], literal.positive

    def condition(self, literals: Iterable[Literal]) -> Condition:
        """The condition that some literals make up."""
        found = {*map(self.literal, literals)}
        return Condition(
            tuple(sorted(fact for fact, positive in found if positive)),
            tuple(sorted(fact for fact, positive in found if not positive)),
        )

    def timed_fact(self, epoch: int, literal: Literal) -> TimedFact | None:
        """A literal that becomes true with an epoch; None where it makes no difference."""
        fact = self._ids.get(self.facts.get(literal.key, -1))
        return None if fact is None else TimedFact(epoch, fact, literal.positive)

    def actions(self, epochs: Callable[[Key, Cost], int]) -> list[GroundAction]:
        """The actions without those that only wait, ascending in name, then in all the rest; each once.

        A blank is less than any character of a word, so this is the order of ``key``.

        Args:
            epochs: how many an action of that name takes, given its duration.
        """
        actions: list[GroundAction] = []
        for block in self._work.deadline.each(self.blocks, 1):
            actions += (
                self._ground(block) if block.durations is None else self._ground_durative(block, epochs)
            )
        self._work.stage(f"sorting {len(actions):,} ground actions")
        return in_order(actions)

    def _ground(self, block: Block) -> Iterator[GroundAction]:
        block = self._renumbered(block)
        if all(() in column.table for column in block.columns):
            block = self._without_waiting(block)
        columns = [column.rows() for column in block.columns]
        names = map(" ".join, block.keys)
        return map(GroundAction, names, block.participants, *columns, _checked(block))

    def _ground_durative(self, block: Block, epochs: Callable[[Key, Cost], int]) -> Iterator[GroundAction]:
        """Actions of several epochs, or of one where their durations are so short."""
        _checked(block)
        block = self._without_waiting(self._renumbered(block))
        for record in block.records():
            action = timed_action(record, epochs)
            if action is not None:
                yield action

    def _renumbered(self, block: Block) -> Block:
        columns: list[Column] = []
        for i, column in enumerate(block.columns):
            if any(column is deleted for deleted in block.deleted):
                columns.append(_without(_renumbered(column, self._ids), columns[-1]))
            else:
                columns.append(_renumbered(column, self._possible if i % 2 else self._changing))
        return replace(block, columns=tuple(columns))

    def _without_waiting(self, block: Block) -> Block:
        """The actions that ask for something, or change something; names of the others are noted."""
        acting = []
        for record in block.records():
            acting.append(not record.only_waits)
            if not acting[-1] and len(record.participants) == 1:
                self.waiting.add((" ".join(record.key), record.participants[0]))
        return block.only(acting)


def in_order(actions: Sequence[GroundAction]) -> list[GroundAction]:
    """Actions ascending in name, then in all the rest; each once."""
    if len({action.name for action in actions}) == len(actions):
        return sorted(actions, key=attrgetter("name"))
    return sorted(set(actions), key=attrgetter(*GroundAction.__slots__))


def _checked(block: Block) -> list[Fraction]:
    """The costs of a block's actions."""
    for key, cost in zip(block.keys, block.costs, strict=True):
        if isinstance(cost, BadCost):
            raise cost.error(key)
    return cast(list[Fraction], block.costs)


def _renumbered(column: Column, ids: Mapping[int, int]) -> Column:
    """The facts that have new ids, ascending."""
    rows: Iterable[Iterable[int]]
    if ids.keys() >= {*chain.from_iterable(column.table)}:
        rows = map(map, repeat(ids.__getitem__), column.table)
    else:
        rows = [[ids[fact] for fact in row if fact in ids] for row in column.table]
    return Column([*map(tuple, map(sorted, map(set, rows)))], column.places)


def _without(deleted: Column, added: Column) -> Column:
    """The deleted facts that are not added at the same time."""
    if {*deleted.facts()}.isdisjoint(added.facts()):
        return deleted
    pairs = [*zip(deleted.places, added.places, strict=True)]
    places = {pair: place for place, pair in enumerate(dict.fromkeys(pairs))}
    table = [tuple([fact for fact in deleted.table[d] if fact not in added.table[a]]) for d, a in places]
    return Column(table, [places[pair] for pair in pairs])
