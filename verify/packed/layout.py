"""Where facts stand in the words of a packed state."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.uint64]
"""States, a row each."""

Ints = NDArray[np.int64]

_BITS = 64


class Effects(Protocol):
    """What matters of an action for the question which facts exclude each other."""

    @property
    def pre(self) -> tuple[int, ...]:
        """Facts that must be true."""

    @property
    def add(self) -> tuple[int, ...]:
        """Facts that it makes true."""

    @property
    def delete(self) -> tuple[int, ...]:
        """Facts that it makes false."""


@dataclass(frozen=True, slots=True)
class WordField:
    """A part of a word: 0 where none of its facts is true, else the number of the one that is, from 1."""

    word: int
    shift: int
    bits: int
    facts: tuple[int, ...]

    @property
    def mask(self) -> int:
        """Its bits in the word."""
        return ((1 << self.bits) - 1) << self.shift

    @property
    def size(self) -> int:
        """The number of its values."""
        return len(self.facts) + 1


class FieldPlace(NamedTuple):
    """A fact's field, by number, and the value there that means it."""

    field: int
    value: int


class NotPackedError(Exception):
    """A state in which facts are true that exclude each other where actions alone lead."""


class PackedLayout:
    """Fields of facts.

    Args:
        groups: disjoint sets of facts of which at most one is ever true.
        actions: all that is to be said of these fields.
    """

    def __init__(
        self, facts: Iterable[int], groups: Iterable[frozenset[int]], actions: Sequence[Effects]
    ) -> None:
        left = set(facts)
        parts: list[tuple[int, ...]] = []
        for group in groups:
            kept = group & left
            if len(kept) > 1 and all(_readable(kept, action) for action in actions):
                parts.append(tuple(sorted(kept)))
                left -= kept
        parts += [(fact,) for fact in sorted(left)]
        self.fields: list[WordField] = []
        self.place: dict[int, FieldPlace] = {}
        word, used = 0, 0
        for part in sorted(parts, key=lambda part: (-len(part), part)):
            bits = len(part).bit_length()
            if used + bits > _BITS:
                word, used = word + 1, 0
            for value, fact in enumerate(part, start=1):
                self.place[fact] = FieldPlace(len(self.fields), value)
            self.fields.append(WordField(word, used, bits, part))
            used += bits
        self.words = word + 1

    def pack(self, states: Sequence[frozenset[int]]) -> Words:
        """States as rows; facts that are not kept are left out.

        Raises:
            NotPackedError: facts of one field are true together.
        """
        rows = np.zeros((len(states), self.words), np.uint64)
        for row, state in enumerate(states):
            filled = [0] * self.words
            for fact in state:
                place = self.place.get(fact)
                if place is not None:
                    field = self.fields[place.field]
                    if filled[field.word] & field.mask:
                        raise NotPackedError
                    filled[field.word] |= place.value << field.shift
            rows[row] = filled
        return rows

    def values(self, field: int, states: Words) -> Ints:
        """The value of a field in each state."""
        at = self.fields[field]
        masked: Words = (states[:, at.word] & np.uint64(at.mask)) >> np.uint64(at.shift)
        return masked.astype(np.int64)

    def facts_of(self, row: Words) -> frozenset[int]:
        """The kept facts that are true in a state."""
        found = set()
        for field in self.fields:
            value = (int(row[field.word]) & field.mask) >> field.shift
            if value:
                found.add(field.facts[value - 1])
        return frozenset(found)


def _readable(group: frozenset[int], action: Effects) -> bool:
    """Whether a group's field is known afterwards: what only deletes needs one of it, or deletes all."""
    deleted = group.intersection(action.delete)
    if not deleted or not group.isdisjoint(action.add):
        return True
    return not group.isdisjoint(action.pre) or group <= deleted
