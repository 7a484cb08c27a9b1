"""What robots can do: their walks, and their ops as a field sees them.

Glossary: *place* - the value of the field that most of a robot's own ops ask for.
"""

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from typing import TypeVar

from search.packed.operators import Operator, Signature, set_by, split
from search.packed.packed_task import PackedTask
from serendipity.model.deadline import Deadline

Item = TypeVar("Item")


class PositionVariables:
    """The place field of each robot, and what moves it.

    Attributes:
        field: per robot's bit its place field, 0 where it has none.
        moves: per robot and place, -1 for anywhere, what sets its place: the place, and the op.
        walks: the same with the index of the op's cost.
    """

    def __init__(self, packed: PackedTask, deadline: Deadline) -> None:
        self.field: dict[int, int] = {}
        self.moves: dict[int, dict[int, list[tuple[int, Operator]]]] = {}
        forms = (*packed.own_forms, *packed.joint_forms, *packed.other_forms)
        for robot in packed.task.robots:
            bit = 1 << robot
            mine = [form for form in packed.other_forms if form.agents & bit]
            foreign = set_by(form for form in forms if not form.agents & bit)
            private = set_by(mine) & ~foreign
            counts = {
                field: sum(len(form.ops) for form in mine if form.need_mask & field)
                for field in packed.fields
                if field & private
            }
            field = max(counts, key=lambda f: counts[f], default=0)
            self.field[bit] = field
            moves: dict[int, list[tuple[int, Operator]]] = {}
            for form in mine:
                if not field & form.sets:
                    continue
                # Without a condition on the place it can be done from anywhere: key -1.
                anywhere = not form.need_mask & field
                for op in form.ops:
                    deadline.tick()
                    moves.setdefault(-1 if anywhere else op.need & field, []).append((op.put & field, op))
            self.moves[bit] = moves
        self.walks = {bit: _walks(moves, frozenset()) for bit, moves in self.moves.items()}


class TransitionGraph:
    """Robots' ops as one outside field sees them.

    Attributes:
        walks: per robot and place what leads elsewhere without mentioning the field: the
            place, and the index of the cost.  Walks that are possible anywhere stand under -1.
    """

    def __init__(self, field: int, forms: Sequence[Signature], places: PositionVariables) -> None:
        self._on = by_value(field, forms)
        self._places = places.field
        self._here: dict[tuple[int, int], dict[int, list[Operator]]] = {}
        self.walks = places.walks
        if any(
            form.agents & bit and form.sets & place for form in forms for bit, place in self._places.items()
        ):
            mentioning = {op.action for form in forms for op in form.ops}
            self.walks = {robot: _walks(moves, mentioning) for robot, moves in places.moves.items()}

    def on(self, value: int) -> list[Operator]:
        """What robots can do to a value of the field."""
        return with_anything(self._on, value)

    def from_place(self, robot: int, place: int) -> list[tuple[int, int]]:
        """Where a robot can walk from a place, with the index of the cost."""
        return with_anything(self.walks[robot], place)

    def by_place(self, value: int, robot: int) -> dict[int, list[Operator]]:
        """What a robot can do to a value of the field, by its place (-1: anywhere)."""
        found = self._here.get((value, robot))
        if found is None:
            found = self._here[value, robot] = {}
            place = self._places[robot]
            for op in self.on(value):
                if op.agents & robot:
                    found.setdefault(op.need & place if op.need_mask & place else -1, []).append(op)
        return found


class TransitionGraphs:
    """:class:`TransitionGraph` by field, made when first asked for.

    Args:
        packed: the packed task.
        places: where robots are.
    """

    def __init__(self, packed: PackedTask, places: PositionVariables) -> None:
        self.places = places
        self._mentioning: dict[int, list[Signature]] = {}
        by_lowest_bit = {field & -field: field for field in packed.fields}
        for form in packed.other_forms:
            for field in split(form.mentions, by_lowest_bit):
                self._mentioning.setdefault(field, []).append(form)
        self._known: dict[int, TransitionGraph] = {}

    def on(self, field: int) -> TransitionGraph:
        """What robots' ops are to a field."""
        if field not in self._known:
            forms = self._mentioning.get(field, ())
            self._known[field] = TransitionGraph(field, forms, self.places)
        return self._known[field]


def with_anything(by_value: dict[int, list[Item]], value: int) -> list[Item]:
    """What stands under a value or a place, and what stands under all of them (-1)."""
    anything = by_value.get(-1)
    known = by_value.get(value, [])
    return known + anything if anything else known


def _walks(
    moves: dict[int, list[tuple[int, Operator]]], but: AbstractSet[int]
) -> dict[int, list[tuple[int, int]]]:
    """Moves with the index of their cost, some actions left out."""
    return {
        origin: [(there, op.cost) for there, op in ops if op.action not in but]
        for origin, ops in moves.items()
    }


def by_value(field: int, forms: Iterable[Signature]) -> dict[int, list[Operator]]:
    """Ops by the value of a field that they ask for; under -1 where they don't."""
    found: dict[int, list[Operator]] = {}
    for form in forms:
        if not form.need_mask & field:
            found.setdefault(-1, []).extend(form.ops)
            continue
        for op in form.ops:
            found.setdefault(op.need & field, []).append(op)
    return found
