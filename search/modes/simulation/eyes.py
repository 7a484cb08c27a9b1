"""Looks: the human's belief after they have looked up (semantics 6)."""

from collections.abc import Callable

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
        self._sees = sees
        self._seen: dict[int, int] = {}

    def look(self, belief: int, state: int) -> int:
        """The belief after a look at the packed state."""
        at = state & self._depends
        seen = self._seen.get(at)
        if seen is None:
            seen = self._seen[at] = self._sees(at)
        return belief & ~seen | state & seen


def everywhere() -> Eyes:
    """The observant human: they see the whole state."""
    return Eyes(0, lambda _: -1)


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

    def sees(positions: int) -> int:
        here = [(who, place) for mask, value, who, place in located if positions & mask == value]
        at = {place for who, place in here if who == human}
        return union(naming.get(name, 0) for name in at.union(who for who, place in here if place in at))

    return Eyes(union(mask for mask, *_ in located), sees)


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
