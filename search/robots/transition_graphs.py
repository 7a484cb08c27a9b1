"""Transition graphs of variables: robots' walks, and their ops as one field sees them.

Glossary: *place* - the value of the field that most of a robot's own ops ask for.
"""

from collections.abc import Sequence

from search.packed.operator_index import OperatorIndex, by_variable, most_asked
from search.packed.operators import Operator, Signature, set_by
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline

Moves = OperatorIndex[tuple[int, Operator]]
"""By a robot's place what sets it: the place after it, and the op."""


class PositionVariables:
    """The place field of each robot, and what moves it.

    Attributes:
        field: per robot's bit its place field, 0 where it has none.
        moves: per robot's bit what sets its place.
    """

    def __init__(self, packed: PackedTask, deadline: Deadline) -> None:
        self.field: dict[int, int] = {}
        self.moves: dict[int, Moves] = {}
        forms = (*packed.own_forms, *packed.joint_forms, *packed.other_forms)
        for robot in packed.task.robots:
            bit = 1 << robot
            mine = [form for form in packed.other_forms if form.agents & bit]
            foreign = set_by(form for form in forms if not form.agents & bit)
            private = set_by(mine) & ~foreign
            fields = [field for field in packed.fields if field & private & ~packed.freedom]
            field = most_asked(fields, ((form.need_mask, len(form.ops)) for form in mine))
            self.field[bit] = field
            moves = self.moves[bit] = OperatorIndex(field)
            for form in mine:
                if field & form.sets:
                    for op in form.ops:
                        deadline.tick()
                        moves.add(op.need_mask, op.need, (op.put & field, op))


class TransitionGraph:
    """Robots' ops as one outside field sees them.

    Attributes:
        walks: per robot's bit what leads elsewhere without mentioning the field.
        walks_mention: whether some moves are left out for that.
    """

    def __init__(self, field: int, forms: Sequence[Signature], places: PositionVariables) -> None:
        self._on = by_variable(field, forms)
        self._places = places.field
        self._here: dict[tuple[int, int], OperatorIndex[Operator]] = {}
        self.walks = places.moves
        self.walks_mention = any(
            form.agents & bit and form.sets & place for form in forms for bit, place in self._places.items()
        )
        if self.walks_mention:
            mentioning = {op.action for form in forms for op in form.ops}
            self.walks = {robot: _without(moves, mentioning) for robot, moves in places.moves.items()}

    def on(self, value: int) -> list[Operator]:
        """What robots can do to a value of the field."""
        return self._on.at(value)

    def by_place(self, value: int, robot: int) -> OperatorIndex[Operator]:
        """What a robot can do to a value of the field, by its place."""
        found = self._here.get((value, robot))
        if found is None:
            found = self._here[value, robot] = OperatorIndex(self._places[robot])
            for op in self.on(value):
                if op.agents & robot:
                    found.add(op.need_mask, op.need, op)
        return found


class TransitionGraphs:
    """:class:`TransitionGraph` by field, made when first asked for; ``places`` are where robots are."""

    def __init__(self, packed: PackedTask, places: PositionVariables) -> None:
        self.places = places
        self._mentioning: dict[int, list[Signature]] = {}
        for form in packed.other_forms:
            for field in packed.split(form.mentions):
                self._mentioning.setdefault(field, []).append(form)
        self._known: dict[int, TransitionGraph] = {}

    def on(self, field: int) -> TransitionGraph:
        """What robots' ops are to a field."""
        if field not in self._known:
            forms = self._mentioning.get(field, ())
            self._known[field] = TransitionGraph(field, forms, self.places)
        return self._known[field]


def _without(moves: Moves, actions: set[int]) -> Moves:
    """Moves but for some actions."""
    walks: Moves = OperatorIndex(moves.field)
    walks.always = [move for move in moves.always if move[1].action not in actions]
    for place, listed in moves.by_value.items():
        walks.by_value[place] = [move for move in listed if move[1].action not in actions]
    return walks
