"""Operators found by what they ask for: the ones that may be applicable in a state, and few others.

Two ways to look them up: :class:`OperatorIndex` by the value of one variable, where most operators
ask for the same one (a position, as a rule); :class:`LiteralIndex` by a variable of each one's own.
What is found has still to be tested.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Generic, TypeVar

from search.packed.operators import Operator, Signature, split
from serendipity.model.resources.deadline import Deadline

Item = TypeVar("Item")


class OperatorIndex(Generic[Item]):
    """Operators, or what stands for them, by the value of one variable.

    Attributes:
        field: the variable's mask; 0 where nothing is told apart.
        by_value: what asks for a value of it.
        always: what does not ask for it.
    """

    __slots__ = ("always", "by_value", "field")

    def __init__(self, field: int) -> None:
        self.field = field
        self.by_value: dict[int, list[Item]] = {}
        self.always: list[Item] = []

    def add(self, need_mask: int, need: int, item: Item) -> None:
        """Add what asks for a packed condition."""
        if need_mask & self.field:
            self.by_value.setdefault(need & self.field, []).append(item)
        else:
            self.always.append(item)

    def at(self, value: int) -> list[Item]:
        """What may be possible at a value of the variable; not to be changed."""
        known = self.by_value.get(value)
        if known is None:
            return self.always
        return known + self.always if self.always else known

    def candidates(self, state: int) -> list[Item]:
        """What may be possible in a packed state; not to be changed."""
        return self.at(state & self.field)


class LiteralIndex(Generic[Item]):
    """Operators, or what stands for them, each under one variable and value that it asks for.

    Where many variables matter (a place each, say), no single one tells operators apart.
    """

    def __init__(self) -> None:
        self._always: list[Item] = []
        self._under: dict[int, dict[int, list[Item]]] = {}

    def add(self, field: int, value: int, item: Item) -> None:
        """Add what asks for a value of a variable; 0 for the variable where it asks for nothing."""
        if field:
            self._under.setdefault(field, {}).setdefault(value, []).append(item)
        else:
            self._always.append(item)

    def candidates(self, state: int) -> list[Item]:
        """What may be possible in a packed state: first what asks for nothing, then by variable."""
        found = self._always[:]
        for field, by_value in self._under.items():
            items = by_value.get(state & field)
            if items is not None:
                found += items
        return found


def most_asked(fields: Sequence[int], asked: Iterable[tuple[int, int]]) -> int:
    """Of some variables the first that most operators ask for; 0 if there is none to choose."""
    by_lowest_bit = {field & -field: field for field in fields}
    by_mask: Counter[int] = Counter()
    for mask, count in asked:
        by_mask[mask] += count
    among = sum(fields)
    by_field: Counter[int] = Counter()
    for mask, count in by_mask.items():
        for field in split(mask & among, by_lowest_bit):
            by_field[field] += count
    return max(fields, key=lambda field: by_field[field], default=0)


def by_variable(field: int, signatures: Iterable[Signature]) -> OperatorIndex[Operator]:
    """Operators by the value of a variable that is given."""
    index: OperatorIndex[Operator] = OperatorIndex(field)
    by_value = index.by_value
    for signature in signatures:
        if not signature.need_mask & field:
            index.always += signature.ops
            continue
        for op in signature.ops:
            by_value.setdefault(op.need & field, []).append(op)
    return index


def by_most_asked(
    signatures: Sequence[Signature], fields: Sequence[int], deadline: Deadline
) -> OperatorIndex[Operator]:
    """Operators by the value of the variable that most of them ask for."""
    asked = ((signature.need_mask, len(signature.ops)) for signature in signatures)
    return by_variable(most_asked(fields, asked), deadline.each(signatures, batch=1))
