"""Looks: the human's belief after they have looked up (semantics 6)."""

from collections.abc import Callable
from functools import cache

from search.packed.operators import union
from search.packed.packed_task import PackedTask
from serendipity.model.task.visibility import Surroundings, Visible


class Eyes:
    """A way to see, which changes a belief.

    Args:
        depends: the fields on which it depends what they see.
        sees: the fields that they see, by what the former are.
    """

    def __init__(self, depends: int, sees: Callable[[int], int]) -> None:
        self._depends = depends
        self._sees = cache(sees)

    def look(self, belief: int, state: int) -> int:
        """The belief after a look at the packed state."""
        seen = self._sees(state & self._depends)
        return belief & ~seen | state & seen


def nearby(encoding: PackedTask, places: Surroundings) -> Eyes:
    """The local human: they see what is where they are, or all where nothing is anywhere."""
    if not places.located:
        return Eyes(0, lambda _: encoding.all_ones)
    human, naming = encoding.task.agents[encoding.task.human], _naming(encoding, places)
    located = [
        (*bits, who, place)
        for fact, (who, place) in places.located.items()
        if (bits := encoding.fact_bits[fact]) is not None
    ]

    def near(state: int) -> set[str]:
        """Names of what is near the human, their place among them."""
        here = [(who, place) for mask, value, who, place in located if state & mask == value]
        at = {place for who, place in here if who == human}
        return at.union(who for who, place in here if place in at)

    depends = union(mask for mask, *_ in located)
    facts = Eyes(depends, lambda positions: union(naming.get(name, 0) for name in near(positions)))
    return SeesWork(encoding, near, facts) if encoding.task.due else facts


class SeesWork(Eyes):
    """The local human in single epochs: they also see what those are at whom they see (semantics 10.6).

    Others they take to go on with what they were at, unless somebody whom they see was at it, too.

    Args:
        near: whom they see.
        facts: how they see all other facts.
    """

    def __init__(self, encoding: PackedTask, near: Callable[[int], set[str]], facts: Eyes) -> None:
        task, clock = encoding.task, encoding.clock_bit
        self._facts, self._near, self._agents = facts, near, task.agents
        self._known = 1 << task.human | clock | sum(1 << person for person in task.script.people)
        self._ticks = union(field for field, _, op in encoding.due if op.agents == clock)
        self._work = [
            (field, value, op.agents) for field, value, op in encoding.due if not field & self._ticks
        ]
        free = {task.facts[fact]: encoding.fact_bits[fact] for fact in task.at_rest}
        self._free = [
            (1 << i, bits) for i, name in enumerate(task.agents) if (bits := free.get(f"free {name}"))
        ]

    def look(self, belief: int, state: int) -> int:
        """See :class:`Eyes`."""
        near = self._near(state)
        shown = self._known | sum(1 << i for i, name in enumerate(self._agents) if name in near)
        shown |= union(
            agents for mask, value, agents in self._work if state & mask == value and agents & shown
        )
        work = [(mask, value, agents) for mask, value, agents in self._work if agents & shown]
        seen = self._ticks | union(mask for mask, *_ in work)
        seen |= union(mask for agent, (mask, _) in self._free if agent & shown)
        found = self._facts.look(belief, state) & ~seen | state & seen
        over = union(agents for mask, value, agents in work if belief & mask == value != state & mask)
        for agent, (mask, value) in self._free:
            if agent & over & ~shown:
                found = found & ~mask | value
        return found


def as_told(encoding: PackedTask, visible: Visible) -> Eyes:
    """The local human of a caller who says themselves what is visible."""
    human = encoding.task.human
    packed = [(fact, *bits) for fact, bits in enumerate(encoding.fact_bits) if bits is not None]

    def sees(state: int) -> int:
        facts = frozenset(fact for fact, mask, value in packed if state & mask == value)
        return union(mask for fact, mask, _ in packed if visible(human, fact, facts))

    return Eyes(-1, sees)


def _naming(encoding: PackedTask, places: Surroundings) -> dict[str, int]:
    """Per name the fields of the facts that are about it."""
    naming: dict[str, int] = {}
    for fact, parts in enumerate(places.parts):
        bits = encoding.fact_bits[fact]
        if bits is not None:
            for part in parts:
                naming[part] = naming.get(part, 0) | bits[0]
    return naming
