"""What the human comes to believe when he looks up (semantics 6).

A belief of his may hold two values of one variable, or none: he saw that the kit has
left the room, but not where it went.  So for him only the variables that nobody
else changes stay variables, of which he always knows the truth; every other fact is
a bit by itself.
"""

from dataclasses import replace
from typing import Protocol

from search.packed.packed_task import PackedTask
from search.simulation.diversions import diversions
from serendipity.model.deadline import Deadline
from serendipity.model.task import Task
from serendipity.model.variables import Variable
from serendipity.model.visibility import Surroundings, Visible, surroundings


class Eyes(Protocol):
    """How a look changes a belief."""

    def look(self, belief: int, state: int) -> int:
        """The belief after a look at the packed state."""


class Everywhere:
    """The observant human: he sees the whole state."""

    def look(self, belief: int, state: int) -> int:
        """See :class:`Eyes`."""
        return state


class Nearby:
    """The local human: he sees what is where he is."""

    def __init__(self, encoding: PackedTask, places: Surroundings) -> None:
        task = encoding.task
        self._human = task.agents[task.human]
        self._naming = _naming(encoding, places)
        self._located = [
            (*bits, who, place)
            for fact, (who, place) in places.located.items()
            if (bits := encoding.fact_bits[fact]) is not None
        ]
        self._positions = 0
        for mask, *_ in self._located:
            self._positions |= mask
        self._everything = 0 if places.located else encoding.all_ones
        self._seen: dict[int, int] = {}

    def look(self, belief: int, state: int) -> int:
        """See :class:`Eyes`."""
        positions = state & self._positions
        seen = self._seen.get(positions)
        if seen is None:
            seen = self._seen[positions] = self._everything | self._mask(positions)
        return belief & ~seen | state & seen

    def _mask(self, positions: int) -> int:
        here = [(who, place) for mask, value, who, place in self._located if positions & mask == value]
        places = {place for who, place in here if who == self._human}
        near = places.union(who for who, place in here if place in places)
        seen = 0
        for name in near:
            seen |= self._naming.get(name, 0)
        return seen


class AsTold:
    """The local human of a caller who says himself what is visible."""

    def __init__(self, encoding: PackedTask, visible: Visible) -> None:
        self._encoding = encoding
        self._visible = visible
        self._seen: dict[int, int] = {}

    def look(self, belief: int, state: int) -> int:
        """See :class:`Eyes`."""
        seen = self._seen.get(state)
        if seen is None:
            seen = self._seen[state] = self._mask(state)
        return belief & ~seen | state & seen

    def _mask(self, state: int) -> int:
        human, bits = self._encoding.task.human, self._encoding.fact_bits
        facts = frozenset(f for f, b in enumerate(bits) if b is not None and state & b[0] == b[1])
        seen = 0
        for fact, b in enumerate(bits):
            if b is not None and self._visible(human, fact, facts):
                seen |= b[0]
        return seen


def doubtful_encoding(task: Task, extra: frozenset[int], deadline: Deadline) -> PackedTask:
    """The task packed for a human who may be wrong, location facts included.

    Args:
        task: the task.
        extra: facts to pack besides; without any the encoding is kept with the task.
        deadline: asked for time.
    """
    if not extra:
        return task.derived(_doubtful, deadline)
    return _packed(task, extra.union(surroundings(task, deadline.tick).located), deadline)


def complete_encoding(task: Task, deadline: Deadline) -> PackedTask:
    """The same with every fact packed, for callers who say what is visible; kept with it."""
    return task.derived(_complete, deadline)


def _doubtful(task: Task, deadline: Deadline) -> PackedTask:
    return _packed(task, frozenset(surroundings(task, deadline.tick).located), deadline)


def _complete(task: Task, deadline: Deadline) -> PackedTask:
    return _packed(task, frozenset(range(len(task.facts))), deadline)


def _packed(task: Task, facts: frozenset[int], deadline: Deadline) -> PackedTask:
    return PackedTask(_doubted(task, deadline), facts, deadline, diversions(task, deadline))


def _doubted(task: Task, deadline: Deadline) -> Task:
    """The task for somebody who may be wrong about everything that others change.

    His own variables stay; every other fact is one by itself.
    """
    shared: set[int] = set()
    for action in task.actions:
        deadline.tick()
        if task.human not in action.participants:
            shared.update(action.add, action.delete)
    found: list[Variable] = []
    for variable in task.variables:  # which take long to find: they are not looked for again
        deadline.tick()
        if shared.isdisjoint(variable.facts):
            found.append(variable)
        else:
            found += [Variable((fact,)) for fact in variable.facts]
    return replace(task, known_variables=tuple(sorted(found, key=lambda variable: variable.facts)))


def _naming(encoding: PackedTask, places: Surroundings) -> dict[str, int]:
    """Per name the fields of the facts that are about it."""
    naming: dict[str, int] = {}
    for fact, parts in enumerate(places.parts):
        bits = encoding.fact_bits[fact]
        if bits is not None:
            for part in parts:
                naming[part] = naming.get(part, 0) | bits[0]
    return naming
