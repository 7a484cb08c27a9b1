"""Looks: the human's belief after they have looked up (semantics 6)."""

from typing import Protocol

from search.packed.packed_task import PackedTask
from serendipity.model.task.visibility import Surroundings, Visible


class Eyes(Protocol):
    """A way to see, which changes a belief."""

    def look(self, belief: int, state: int) -> int:
        """The belief after a look at the packed state."""


class Everywhere:
    """The observant human: they see the whole state."""

    def look(self, belief: int, state: int) -> int:
        """See :class:`Eyes`."""
        return state


class Nearby:
    """The local human: they see what is where they are."""

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
    """The local human of a caller who says themselves what is visible."""

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


def _naming(encoding: PackedTask, places: Surroundings) -> dict[str, int]:
    """Per name the fields of the facts that are about it."""
    naming: dict[str, int] = {}
    for fact, parts in enumerate(places.parts):
        bits = encoding.fact_bits[fact]
        if bits is not None:
            for part in parts:
                naming[part] = naming.get(part, 0) | bits[0]
    return naming
