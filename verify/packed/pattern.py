"""A pattern: exact distances to the goal where only some fields are looked at, as a table."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.packed.edges import distances
from verify.packed.layout import Ints, PackedLayout, Words
from verify.packed.operators import FAR, OperatorTable, Test

_BYTES_A_MOVE: Final = 80


class Pattern:
    """The states over some fields, and the moves between them.

    Forgetting a field makes operators applicable in more states, so that distances never grow.

    Args:
        fields: by number.
        most_moves: between its states; they all stand in memory.

    Attributes:
        fields: by number.
    """

    def __init__(
        self, table: OperatorTable, fields: Sequence[int], most_moves: int, deadline: Deadline
    ) -> None:
        self._layout: PackedLayout = table.layout
        self._deadline = deadline
        self.fields = tuple(fields)
        self._sizes = [self._layout.fields[f].size for f in fields]
        self._strides = list(np.cumprod([1, *self._sizes])[:-1].tolist())
        self.size = int(np.prod(self._sizes, dtype=np.int64))
        self._index = {field: k for k, field in enumerate(fields)}
        self._write(table, most_moves)

    def _write(self, table: OperatorTable, most_moves: int) -> None:
        """All moves, by operators that look alike here: sources, targets, numbers of such a class."""
        self.classes: Ints = np.full(len(table.operators), -1)
        """By operator: the class of those that look alike; -1 for those that change nothing here."""
        kinds: dict[tuple[tuple[tuple[int, int], ...], tuple[tuple[int, int], ...]], int] = {}
        for number in range(len(table.operators)):
            effects = self._seen(table.effects[number])
            if effects and not table.impossible[number]:
                kind = self._seen(table.conditions[number]), effects
                self.classes[number] = kinds.setdefault(kind, len(kinds))
        self.kinds = len(kinds)
        sources, targets, labels = [], [], []
        moves = 0
        for (conditions, effects), label in kinds.items():
            self._deadline.tick()
            source = self._matching(dict(conditions))
            moves += len(source)
            if moves > most_moves:
                raise TooManyMovesError
            sources.append(source)
            targets.append(self._moved(source, effects))
            labels.append(np.full(len(source), label))
        self._deadline.require(moves * _BYTES_A_MOVE)
        empty = np.zeros(0, np.int64)
        self.source = np.concatenate([empty, *sources])
        self.target = np.concatenate([empty, *targets])
        self.label = np.concatenate([empty, *labels])

    def _seen(self, values: dict[int, int]) -> tuple[tuple[int, int], ...]:
        return tuple(sorted((self._index[f], v) for f, v in values.items() if f in self._index))

    def _matching(self, conditions: dict[int, int]) -> Ints:
        """The states in which some fields have a value, ascending."""
        found = np.zeros(1, np.int64)
        for k in reversed(range(len(self._sizes))):
            values = np.array([conditions[k]]) if k in conditions else np.arange(self._sizes[k])
            found = (found[:, None] + values * self._strides[k]).ravel()
        return found

    def _moved(self, source: Ints, effects: tuple[tuple[int, int], ...]) -> Ints:
        target = source.copy()
        for k, value in effects:
            here = source // self._strides[k] % self._sizes[k]
            target += (value - here) * self._strides[k]
        return target

    def goals(self, test: Test) -> Ints:
        """The states in which no condition on the fields fails."""
        return self._matching(dict(self._seen(test.conditions)))

    def distances(self, weights: Ints, goals: Ints) -> Ints:
        """Least weight from every state to a goal; ``FAR`` where there is no way.

        Args:
            weights: of each class of operators.
        """
        ends = np.full(self.size, FAR)
        ends[goals] = 0
        return distances((self.target, self.source, weights[self.label]), ends, int(FAR), self._deadline)

    def used(self, distance: Ints, kinds: int) -> Ints:
        """Of each class of operators what the distances make use of, at most its weight."""
        reached = (distance[self.source] < FAR) & (distance[self.target] < FAR)
        drops = distance[self.source[reached]] - distance[self.target[reached]]
        found = np.zeros(kinds, np.int64)
        np.maximum.at(found, self.label[reached], drops)
        return found

    def index(self, states: Words) -> Ints:
        """The pattern's state that each state looks like."""
        found = np.zeros(len(states), np.int64)
        for field, stride in zip(self.fields, self._strides, strict=True):
            found += self._layout.values(field, states) * stride
        return found


class TooManyMovesError(Exception):
    """A pattern whose moves would take too much memory."""
