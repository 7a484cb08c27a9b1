"""Operators over packed states: which are applicable where, and what comes of it, for many states at once."""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import inf
from typing import Final, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from verify.packed.edges import Rows
from verify.packed.layout import Ints, PackedLayout, Words

FAR: Final = np.int64(2**61)
"""No way there, or none that anybody asks about: sums of weights that count are below ``limits().weight``."""

_AT_ONCE: Final = 1 << 16
"""Operators that are looked at in one go, for several states together: each takes some hundred bytes."""


class PackedOperator(NamedTuple):
    """An operator: facts that it needs, forbids, adds and deletes, and its weight."""

    pre: tuple[int, ...]
    neg: tuple[int, ...]
    add: tuple[int, ...]
    delete: tuple[int, ...]
    weight: int


class OperatorTable:
    """Operators as arrays.

    Args:
        layout: where facts stand; those it does not keep are not looked at.
        operators: each heeds the layout's fields (:func:`verify.packed.layout.exclusive`).
        exact: weights are Python's integers, since machine words do not hold their sums.

    Attributes:
        far: more than any sum of weights, as good as no way.
    """

    def __init__(
        self, layout: PackedLayout, operators: Sequence[PackedOperator], *, exact: bool = False
    ) -> None:
        self.layout = layout
        self.operators = operators
        shape = len(operators), layout.words
        self.mask, self.value = np.zeros(shape, np.uint64), np.zeros(shape, np.uint64)
        self.clear, self.put = np.zeros(shape, np.uint64), np.zeros(shape, np.uint64)
        self.weight = np.array([operator.weight for operator in operators], object if exact else np.int64)
        self.far: int = cast(int, inf) if exact else int(FAR)
        self.conditions: list[dict[int, int]] = []
        """By operator: fields that have to have a value."""
        self.effects: list[dict[int, int]] = []
        """By operator: fields that get a value."""
        self.impossible = np.zeros(len(operators), bool)
        forbidden: list[tuple[int, int, int]] = []
        for number, operator in enumerate(operators):
            forbidden += self._read(number, operator)
        self._forbidden = np.array(forbidden, np.int64).reshape(-1, 3)
        self._has_forbidden = np.zeros(len(operators), bool)
        self._has_forbidden[self._forbidden[:, 0]] = True
        self._index()

    def _read(self, number: int, operator: PackedOperator) -> Iterator[tuple[int, int, int]]:
        """Enter an operator; the values that it forbids where none is needed."""
        fields = self.layout.fields
        needed = self._needed(number, operator)
        for at in (self.layout.place[fact] for fact in operator.neg if fact in self.layout.place):
            if needed.get(at.field, 0) == at.value:
                self.impossible[number] = True
            elif at.field not in needed:
                if len(fields[at.field].facts) == 1:
                    needed[at.field] = 0
                else:
                    yield number, at.field, at.value
        gets = self._gets(operator, needed)
        for field, value in needed.items():
            self.mask[number, fields[field].word] |= np.uint64(fields[field].mask)
            self.value[number, fields[field].word] |= np.uint64(value << fields[field].shift)
        for field, value in gets.items():
            self.clear[number, fields[field].word] |= np.uint64(fields[field].mask)
            self.put[number, fields[field].word] |= np.uint64(value << fields[field].shift)
        self.conditions.append(needed)
        self.effects.append({f: v for f, v in gets.items() if needed.get(f) != v})

    def _needed(self, number: int, operator: PackedOperator) -> dict[int, int]:
        """The values that an operator's true facts are."""
        needed: dict[int, int] = {}
        for at in (self.layout.place[fact] for fact in operator.pre if fact in self.layout.place):
            if needed.setdefault(at.field, at.value) != at.value:
                self.impossible[number] = True
        return needed

    def _gets(self, operator: PackedOperator, needed: dict[int, int]) -> dict[int, int]:
        """The values that fields get."""
        place, fields = self.layout.place, self.layout.fields
        gets = {place[fact].field: 0 for fact in operator.delete if fact in place}
        for field in list(gets):  # what is deleted where another fact is true stays as it is
            facts = fields[field].facts
            if needed.get(field, 0) and facts[needed[field] - 1] not in operator.delete:
                del gets[field]
        gets.update((place[fact].field, place[fact].value) for fact in operator.add if fact in place)
        return gets

    def _index(self) -> None:
        """Each operator under the value that it needs and the fewest others do."""
        fields = self.layout.fields
        shared = Counter(pair for needed in self.conditions for pair in needed.items())
        base = np.cumsum([0, *(field.size for field in fields)])
        listed: list[tuple[int, int, int]] = []
        always: list[int] = []
        for number, needed in enumerate(self.conditions):
            if self.impossible[number]:
                continue
            if needed:
                listed.append((*min(needed.items(), key=lambda pair: (shared[pair], pair)), number))
            else:
                always.append(number)
        field, value, numbers = np.array(listed, np.int64).reshape(-1, 3).T
        self._listed = Rows.by(base[field] + value, int(base[-1]), numbers)
        keys = np.unique(field).tolist()
        self._key_word = np.array([fields[k].word for k in keys], np.int64)
        self._key_shift = np.array([fields[k].shift for k in keys], np.uint64)
        self._key_mask = np.array([fields[k].mask >> fields[k].shift for k in keys], np.uint64)
        self._key_base = np.array([base[k] for k in keys], np.int64)
        self._always = np.array(always, np.int64)

    def applicable(self, states: Words) -> tuple[Ints, Ints]:
        """Pairs of a state's row and an operator that is applicable there, by rows."""
        values = (states[:, self._key_word] >> self._key_shift) & self._key_mask
        keys = values.astype(np.int64) + self._key_base
        sizes = self._listed.sizes(keys)
        looked_at = np.cumsum(sizes.sum(axis=1) + len(self._always))
        parts = np.split(np.arange(len(states)), np.flatnonzero(np.diff(looked_at // _AT_ONCE)) + 1)
        found = [self._fitting(states, here, keys[here], sizes[here]) for here in parts]
        rows, chosen = zip(*found, strict=True)
        return np.concatenate(rows), np.concatenate(chosen)

    def _fitting(self, states: Words, here: Ints, keys: Ints, sizes: Ints) -> tuple[Ints, Ints]:
        """The same for some rows, of what is listed for them: under which keys, and how much."""
        chosen = self._listed.at(keys.ravel())
        rows = np.repeat(here, sizes.sum(axis=1))
        if len(self._always):
            rows = np.concatenate((rows, np.repeat(here, len(self._always))))
            chosen = np.concatenate((chosen, np.tile(self._always, len(here))))
        fits = ((states[rows] & self.mask[chosen]) == self.value[chosen]).all(axis=1)
        rows, chosen = rows[fits], chosen[fits]
        if len(self._forbidden):
            fits = self._allowed(states, rows, chosen)
            rows, chosen = rows[fits], chosen[fits]
        if len(self._always):
            order = np.argsort(rows, kind="stable")
            rows, chosen = rows[order], chosen[order]
        return rows, chosen

    def _allowed(self, states: Words, rows: Ints, chosen: Ints) -> NDArray[np.bool_]:
        fits = np.ones(len(rows), bool)
        for number, field, value in self._forbidden if self._has_forbidden[chosen].any() else ():
            at = self.layout.fields[field]
            concerned = np.flatnonzero(chosen == number)
            here = states[rows[concerned], at.word] & np.uint64(at.mask)
            fits[concerned[here == np.uint64(int(value) << at.shift)]] = False
        return fits

    def after(self, states: Words, chosen: Ints) -> Words:
        """The results of operators in some states, one in each."""
        return (states & ~self.clear[chosen]) | self.put[chosen]

    def test(self, positive: Sequence[int], negative: Sequence[int]) -> "Test":
        """A test for facts that have to be true and false."""
        return Test(self.layout, positive, negative)


class Test:
    """A test of many states: some facts are true in them and others false."""

    def __init__(self, layout: PackedLayout, positive: Sequence[int], negative: Sequence[int]) -> None:
        self._table = OperatorTable(layout, [PackedOperator(tuple(positive), tuple(negative), (), (), 0)])
        self.conditions = self._table.conditions[0]

    def __call__(self, states: Words) -> NDArray[np.bool_]:
        """By state."""
        holds = np.zeros(len(states), bool)
        holds[self._table.applicable(states)[0]] = True
        return holds
