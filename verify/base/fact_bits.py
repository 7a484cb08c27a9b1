"""Sets of facts as integers with a bit for each: thousands of states take little memory that way."""

from collections.abc import Iterable, Iterator


class FactBits:
    """Numbers some facts.

    Args:
        facts: ids of the facts; all others are left out of every set.
    """

    def __init__(self, facts: Iterable[int]) -> None:
        self._bit = {fact: 1 << number for number, fact in enumerate(sorted(facts))}

    def of(self, facts: Iterable[int]) -> int:
        """A set of facts, as far as they are numbered."""
        bit, found = self._bit, 0
        for fact in facts:
            found |= bit.get(fact, 0)
        return found

    @property
    def all(self) -> int:
        """All the facts."""
        return (1 << len(self._bit)) - 1


def each_bit(bits: int) -> Iterator[int]:
    """The bits of a set one by one, as sets."""
    while bits:
        lowest = bits & -bits
        yield lowest
        bits ^= lowest
