"""Things that are alike: exchanging the names of two of them leaves the task as it is.

Source: symmetries of objects, as of Fox and Long, The detection and exploitation of symmetry in planning
problems (1999); here every exchange is verified on the ground actions.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Final

from search.short_windows.independent.provision import Value
from search.packed.operators import Operator, split
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline

_HOLE: Final = "*"

Shape = tuple[int, int, frozenset[Value | None], frozenset[Value | None], frozenset[Value | None]]
"""An operator by agents, cost, what it asks for, what it must not find, and what it sets."""


class Things:
    """Names that occur in facts, and those among them that are alike.

    Args:
        packed: the packed task.
        deadline: polled.

    Attributes:
        fields: the fields of the packed task by their lowest bit.
        mentioned: by value of a field the names in its fact, but the first, which is a predicate.
    """

    def __init__(self, packed: PackedTask, deadline: Deadline) -> None:
        self._packed = packed
        self._deadline = deadline
        self.fields = {field & -field: field for field in packed.fields}
        self._bits: dict[tuple[str, ...], Value] = {}
        self._words: dict[Value, tuple[str, ...]] = {}
        for fact, bits in enumerate(packed.fact_bits):
            if bits is not None:
                words = tuple(packed.task.facts[fact].split())
                self._bits[words] = bits
                self._words[bits] = words
        self.mentioned = {value: frozenset(words[1:]) for value, words in self._words.items()}

    def of(self, op: Operator) -> set[str]:
        """All names in what an operator asks for, must not find, or sets."""
        found = set[str]()
        sets = self._values(self._packed.all_ones & ~op.keep, op.put)
        for field, value in (*self._values(op.need_mask, op.need), *op.forbidden, *sets):
            found.update(self.mentioned.get((field, value), ()), self._of_field(field))
        return found

    def _of_field(self, field: int) -> frozenset[str]:
        """The names in the fact of a field that is true or false."""
        return self.mentioned.get((field, field), frozenset()) if field & field - 1 == 0 else frozenset()

    def form(self, value: Value, name: str, kind: int) -> tuple[str | int, ...]:
        """The fact of a value with the number of a kind in place of a name."""
        return tuple(kind if word == name else word for word in self._words[value])

    # -- renaming

    def renamed(self, value: Value, names: Mapping[str, str]) -> Value | None:
        """The value of a field that speaks of other things; None where there is no such value."""
        words = self._words.get(value)
        if words is not None:
            return self._bits.get((words[0], *(names.get(word, word) for word in words[1:])))
        field = self.renamed((value[0], value[0]), names)  # a fact that is false
        return None if field is None else (field[0], 0)

    def _shape(self, op: Operator, renamed: Mapping[Value, Value | None] | None = None) -> Shape | None:
        """An operator; with values in place of its own, or None where one of them has none."""
        parts: list[frozenset[Value | None]] = []
        sets = self._packed.all_ones & ~op.keep
        for values in (self._values(op.need_mask, op.need), op.forbidden, self._values(sets, op.put)):
            if renamed is None:
                parts.append(frozenset(values))
                continue
            part = frozenset([renamed[value] for value in values])
            if None in part:
                return None
            parts.append(part)
        asked, forbidden, set_ = parts
        return op.agents, op.cost, asked, forbidden, set_

    def _values(self, fields: int, state: int) -> list[Value]:
        return [(field, state & field) for field in split(fields, self.fields)]

    # -- what is alike

    def alike(self) -> list[list[str]]:
        """Names that can be exchanged for one another, two or more of each kind, in order.

        Raises:
            LimitReachedError: the deadline came.
        """
        found: list[list[str]] = []
        for names in self._candidates():
            kinds: list[list[str]] = []
            for name in names:
                kind = next((kind for kind in kinds if self._can_exchange(kind[0], name)), None)
                if kind is None:
                    kinds.append([name])
                else:
                    kind.append(name)
            found += [kind for kind in kinds if len(kind) > 1]
        return found

    def _candidates(self) -> Iterable[list[str]]:
        """Names of which the same is said."""
        packed = self._packed
        said: dict[str, list[tuple[tuple[str, ...], bool, bool]]] = defaultdict(list)
        for (field, value), words in self._words.items():
            self._deadline.tick()
            starts = packed.init & field == value
            wanted = bool(packed.goal.need_mask & field) and packed.goal.need & field == value
            for name in set(words[1:]):
                form = words[0], *(_HOLE if word == name else word for word in words[1:])
                said[name].append((form, starts, wanted))
        groups: dict[tuple[tuple[tuple[str, ...], bool, bool], ...], list[str]] = defaultdict(list)
        for name, forms in sorted(said.items()):
            groups[tuple(sorted(forms))].append(name)
        return [names for names in groups.values() if len(names) > 1]

    @cached_property
    def _operators(self) -> dict[str, list[Operator]]:
        """By name the operators that speak of it."""
        found: dict[str, list[Operator]] = defaultdict(list)
        for op in (*self._packed.own, *self._packed.joint, *self._packed.others):
            self._deadline.tick()
            for name in self.of(op):
                found[name].append(op)
        return found

    @cached_property
    def _shapes(self) -> set[Shape | None]:
        ops = (*self._packed.own, *self._packed.joint, *self._packed.others)
        return {self._shape(op) for op in self._deadline.each(ops)}

    def _can_exchange(self, one: str, other: str) -> bool:
        """Whether the task is the same if two names are exchanged."""
        names = {one: other, other: one}
        return self._keeps_fields(names) and self._keeps_conditions(names) and self._keeps_operators(names)

    def _keeps_fields(self, names: Mapping[str, str]) -> bool:
        """Whether the values of each field become all those of one field."""
        for field in self._packed.fields:
            values = [value for value in self._packed.values(field) if (field, value) in self._words]
            if any(not self.mentioned[field, value].isdisjoint(names) for value in values):
                renamed = {self.renamed((field, value), names) for value in values}
                into = {value[0] for value in renamed if value is not None}
                if None in renamed or len(into) != 1:
                    return False
                if len(self._packed.values(*into)) != len(self._packed.values(field)):
                    return False
        return True

    def _keeps_conditions(self, names: Mapping[str, str]) -> bool:
        """Whether the initial state and the goals stay as they are."""
        packed = self._packed
        for condition in (packed.goal, packed.robot_goal):
            values = set(self._values(condition.need_mask, condition.need))
            if {self.renamed(value, names) for value in values} != values:
                return False
            if {self.renamed(value, names) for value in condition.forbidden} != set(condition.forbidden):
                return False
        values = {(field, packed.init & field) for field in packed.fields}
        return {self.renamed(value, names) for value in values} == values

    def _keeps_operators(self, names: Mapping[str, str]) -> bool:
        """Whether operators become operators: as many speak of each name, so to look at one's is enough."""
        one, other = names
        if len(self._operators[one]) != len(self._operators[other]):
            return False
        renamed = _Renamed(self, names)
        for op in self._deadline.each(self._operators[one]):
            shape = self._shape(op, renamed)
            if shape is None or shape not in self._shapes:
                return False
        return True


class _Renamed(dict[Value, Value | None]):
    """Values that speak of other things, kept."""

    def __init__(self, things: Things, names: Mapping[str, str]) -> None:
        self._things = things
        self._names = names

    def __missing__(self, value: Value) -> Value | None:
        found = self[value] = self._things.renamed(value, self._names)
        return found
