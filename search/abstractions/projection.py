"""One pattern: the human's own task projected onto a few fields, as arrays (Culberson and Schaeffer 1998).

A state of the projection is a number: the codes of the fields, each times its stride.  Transitions are
arrays of source and target; those of operators that look alike in the projection are one *class*.  What
an operator costs is said anew for each table, so that several patterns can share the costs of one.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from search.abstractions.patterns import Field
from search.packed.cost_vector import FAR
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal
from serendipity.model.resources.deadline import Deadline

Numbers = NDArray[np.int64]
"""One-dimensional."""

Codes = dict[int, int]
"""Codes by the place of their field in the pattern."""


class Projection:
    """States and transitions of a pattern.

    Args:
        fields: what is kept.
        operators: the human's own, by their number.
        goal: what has to hold at the end, as far as the fields say.
        deadline: polled while transitions are made.

    Attributes:
        fields: what is kept.
        n_states: how many states there are.
        n_transitions: how many transitions change one.
    """

    def __init__(
        self, fields: Sequence[Field], operators: Sequence[Operator], goal: PackedGoal, deadline: Deadline
    ) -> None:
        self.fields = tuple(fields)
        self._sizes = [field.size for field in fields]
        strides = [1]
        for size in self._sizes:
            strides.append(strides[-1] * size)
        self.n_states = strides.pop()
        self._strides = strides
        self._combined: dict[tuple[int, ...], Numbers] = {}
        self._goals = self._states(_codes(self.fields, goal.need_mask, goal.need))
        self._members: list[Numbers] = []
        sources: list[Numbers] = []
        targets: list[Numbers] = []
        for (asked, put), members in self._classes(operators, deadline).items():
            deadline.check()
            source, target = self._transitions(dict(asked), dict(put))
            if len(source):
                sources.append(source)
                targets.append(target)
                self._members.append(np.array(members, dtype=np.int64))
        self.n_transitions = sum(map(len, sources))
        if self.n_transitions:
            self._arrange(sources, targets)

    def _classes(
        self, operators: Iterable[Operator], deadline: Deadline
    ) -> dict[tuple[tuple[tuple[int, int], ...], ...], list[int]]:
        """Numbers of operators that change something, by what they ask for and put there."""
        mask = sum(field.mask for field in self.fields)
        alike: dict[tuple[int, int, int, int], list[int]] = {}
        for number, op in enumerate(operators):
            deadline.tick()
            if mask & ~op.keep:
                seen = op.need_mask & mask, op.need & mask, op.keep & mask, op.put & mask
                alike.setdefault(seen, []).append(number)
        return {
            (
                tuple(_codes(self.fields, need_mask, need).items()),
                tuple(_codes(self.fields, mask & ~keep, put).items()),
            ): members
            for (need_mask, need, keep, put), members in alike.items()
        }

    def _transitions(self, asked: Codes, put: Codes) -> tuple[Numbers, Numbers]:
        """Sources and targets of what asks for some codes and puts others; only where they differ."""
        source = self._states(asked)
        target = source
        for place, code in put.items():
            stride = self._strides[place]
            target = target + (code - source // stride % self._sizes[place]) * stride
        changed = target != source
        return source[changed], target[changed]

    def _states(self, asked: Codes) -> Numbers:
        """All states in which some fields have given codes."""
        free = tuple(place for place in range(len(self._sizes)) if place not in asked)
        known = self._combined.get(free)
        if known is None:
            known = np.zeros(1, dtype=np.int64)
            for place in free:
                steps = np.arange(self._sizes[place], dtype=np.int64) * self._strides[place]
                known = (known[None, :] + steps[:, None]).ravel()
            self._combined[free] = known
        return known + sum(code * self._strides[place] for place, code in asked.items())

    def _arrange(self, sources: list[Numbers], targets: list[Numbers]) -> None:
        lengths = np.array([len(source) for source in sources])
        self._source, self._target = np.concatenate(sources), np.concatenate(targets)
        self._first_of_class = np.cumsum(lengths) - lengths
        order = np.argsort(self._source, kind="stable")
        by_source = self._source[order]
        self._first_of_source = np.flatnonzero(np.diff(by_source, prepend=-1))
        self._leaving = by_source[self._first_of_source]
        self._target_by_source = self._target[order]
        self._class_by_source = np.repeat(np.arange(len(lengths)), lengths)[order]

    def distances(self, weights: Numbers, deadline: Deadline) -> Numbers:
        """Per state the least weight of a way to the goal, ``FAR`` where there is none.

        Args:
            weights: of each operator, at least 0.
            deadline: polled in each round.
        """
        found = np.full(self.n_states, FAR, dtype=np.int64)
        found[self._goals] = 0
        if not self.n_transitions:
            return found
        cheapest = np.array([weights[members].min() for members in self._members], dtype=np.int64)
        steps = cheapest[self._class_by_source]
        while True:
            deadline.check()
            known = found[self._leaving]
            through = np.minimum.reduceat(found[self._target_by_source] + steps, self._first_of_source)
            if not (through < known).any():
                return found
            found[self._leaving] = np.minimum(through, known)

    def saturated(self, distances: Numbers, n_operators: int) -> Numbers:
        """Per operator the least weight with which distances stay what they are (Seipp et al. 2020)."""
        needed = np.zeros(n_operators, dtype=np.int64)
        if not self.n_transitions:
            return needed
        before = distances[self._source]
        drop = np.where(before < FAR, before - distances[self._target], 0)
        for members, most in zip(self._members, np.maximum.reduceat(drop, self._first_of_class), strict=True):
            needed[members] = max(most, 0)
        return needed

    def number(self, state: int) -> int:
        """The projection of a packed state."""
        return sum(
            ((state & field.mask) >> field.shift) * stride
            for field, stride in zip(self.fields, self._strides, strict=True)
        )


def _codes(fields: Sequence[Field], mask: int, values: int) -> Codes:
    """What values in place say of the fields in a mask."""
    return {
        place: (values & field.mask) >> field.shift for place, field in enumerate(fields) if field.mask & mask
    }
