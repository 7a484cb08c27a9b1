"""Sets of facts as integers with a bit for each, and a transition system over them.

Thousands of states take little memory that way.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any, NamedTuple

from serendipity.model import Deadline, GroundAction
from verify.packed.bits import bits_of, numbers_in


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

    def operator(self, action: GroundAction, weight: int, label: Any) -> "BitOperator":
        """An action over the facts that are numbered."""
        pre, neg, add, delete = map(self.of, (action.pre, action.neg, action.add, action.delete))
        return BitOperator(pre, neg, add, delete, weight, label)

    @property
    def all(self) -> int:
        """All the facts."""
        return (1 << len(self._bit)) - 1


class BitCondition(NamedTuple):
    """Facts that must hold, and that must not."""

    pre: int
    neg: int

    def holds(self, state: int) -> bool:
        """Whether they do."""
        return state & self.pre == self.pre and not state & self.neg


class BitOperator(NamedTuple):
    """An action, or some at once: what must hold, and must not; what is set and unset; what it weighs.

    Attributes:
        label: the action's id, or all ids.
    """

    pre: int
    neg: int
    add: int
    delete: int
    weight: int
    label: Any = None

    def applicable(self, state: int) -> bool:
        """Whether it can be done in a state."""
        return state & self.pre == self.pre and not state & self.neg

    def after(self, state: int) -> int:
        """The state that it leads to."""
        return state & ~self.delete | self.add


class BitOperators:
    """Operators that are looked up by one of their needs each: the one that the fewest share."""

    def __init__(self, operators: Iterable[BitOperator], deadline: Deadline) -> None:
        every = list(operators)
        count = Counter(fact for operator in deadline.each(every) for fact in numbers_in(operator.pre))
        self._under: dict[int, list[BitOperator]] = {-1: []}
        for operator in deadline.each(every):
            need = min(numbers_in(operator.pre), key=count.__getitem__, default=-1)
            self._under.setdefault(need, []).append(operator)
        self._watched = bits_of(self._under.keys() - {-1})

    def applicable(self, state: int) -> Iterator[BitOperator]:
        """Those that can be done in a state."""
        under = self._under
        for operator in chain(under[-1], *(under[fact] for fact in numbers_in(state & self._watched))):
            if state & operator.pre == operator.pre and not state & operator.neg:
                yield operator

    def __call__(self, state: int) -> Iterator[tuple[int, int, BitOperator]]:
        """For each of them the state after it, and its weight."""
        for operator in self.applicable(state):
            yield state & ~operator.delete | operator.add, operator.weight, operator
