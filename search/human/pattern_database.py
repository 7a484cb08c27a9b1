"""Admissible bounds on what the human still has to pay, by projection.

Their *private* variables are those that no action changes without them.  Projected
onto them, with every other condition dropped, each of their actions (joint ones
included) is a weighted transition; exact distances to the projected goal bound
their share of any plan from below, in every mode, since robots' costs are only
left out.  This is a pattern database (Culberson and Schaeffer 1998) on one
agent's variables.  It depends on the packed task alone; a call has the distances in
its keys.
"""

from collections.abc import Iterable, Sequence
from itertools import accumulate
from operator import mul
from typing import Final, NamedTuple

from search.engine.shortest_paths import backward
from search.packed.cost_vector import INFINITE_KEY, own_actions, own_weights
from search.packed.operator_index import OperatorIndex, most_asked
from search.packed.operators import Signature, forms_of, set_by
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.resources.deadline import Deadline

_MAX_STATES: Final = 50_000

_FEW_STATES: Final = 5_000
"""States after which all private fields together are given up, where they could have more than the most."""

Literals = tuple[tuple[int, int], ...]
"""Fields, and values that they must not have."""

Predecessors = dict[int, list[tuple[int, int]]]
"""Per projected state the cheapest ways to it: weight (:func:`.own_weights`), state before it."""


class PatternDatabase(NamedTuple):
    """Distances to the goal in a projection.

    Attributes:
        mask: the fields that the projection keeps.
        distances: key increment to the goal per projected state; a state that is not
            listed can't reach the goal.
    """

    mask: int
    distances: dict[int, int]

    def __call__(self, state: int) -> int:
        """Lower bound of the key increment from a packed state; ``INFINITE_KEY`` if none."""
        return self.distances.get(state & self.mask, INFINITE_KEY)


NOTHING_KNOWN: Final = PatternDatabase(0, {0: 0})
"""The bound that is always right."""


class NearestGoal(NamedTuple):
    """The bound of :func:`alone_projection`, or where that knows nothing one by private variables."""

    private: PatternDatabase
    alone: PatternDatabase

    @property
    def mask(self) -> int:
        """The fields that it looks at."""
        return self.private.mask | self.alone.mask

    def __call__(self, state: int) -> int:
        """Lower bound on what is left to the human alone from a packed state."""
        found = self.alone.distances.get(state & self.alone.mask)
        return self.private(state) if found is None else found


GoalBound = PatternDatabase | NearestGoal
"""A lower bound on what is left to the human."""


class Projected(NamedTuple):
    """The human's actions projected onto fields of theirs, as far as they lead from ``I``.

    Attributes:
        mask: the fields that are kept.
        moves: per projected state what leads to it.
    """

    mask: int
    moves: Predecessors


def own_projection(packed: PackedTask, graph: Projected, deadline: Deadline) -> PatternDatabase:
    """Costs to the human's goal in their private variables, or in as many as stay tractable.

    Returns:
        Distances in the unit of :func:`search.packed.cost_vector.own_weights`.
    """
    return PatternDatabase(graph.mask, backward(_satisfying(graph, packed.goal), [graph.moves], deadline))


def translated(bound: PatternDatabase, plain: PackedTask, packed: PackedTask) -> PatternDatabase:
    """A bound on private variables, for states that are packed in another way.

    The bound of the other packing itself would also look at single facts of shared
    variables ("the human has the kit"), and grow with every subset of them.

    Args:
        bound: for states of ``plain``.
        plain: the task packed as it is.
        packed: the same, with the same private variables.
    """
    fields: dict[int, dict[int, int]] = {}
    mask = 0
    for fact, bits in enumerate(plain.fact_bits):
        there = packed.fact_bits[fact]
        if bits is not None and there is not None and bits[0] & bound.mask:
            fields.setdefault(bits[0], {})[bits[1]] = there[1]
            mask |= there[0]
    distances = {
        sum(values.get(state & field, 0) for field, values in fields.items()): distance
        for state, distance in bound.distances.items()
    }
    return PatternDatabase(mask, distances)


def steps_in(own: PatternDatabase) -> PatternDatabase:
    """The numbers of actions in what :func:`own_projection` finds."""
    return PatternDatabase(own.mask, {at: own_actions(cost) for at, cost in own.distances.items()})


def human_steps(packed: PackedTask, graph: Projected, deadline: Deadline) -> PatternDatabase:
    """The least number of the human's actions to their goal, in the same variables."""
    counted = {
        at: [(own_actions(weight), before) for weight, before in edges] for at, edges in graph.moves.items()
    }
    return PatternDatabase(graph.mask, backward(_satisfying(graph, packed.goal), [counted], deadline))


def private_fields(packed: PackedTask) -> list[int]:
    """The fields that only the human changes, alone or with others."""
    changed = set_by((*packed.own_forms, *packed.joint_forms))
    return [field for field in packed.fields if field & changed and not field & packed.outside]


def whole_graph(packed: PackedTask, deadline: Deadline) -> Projected | None:
    """The human's graph over all their private fields; None where these are too many together.

    What they could have together is tried for a while, where it could be too much.  How far an action has
    come is left out where it is too much: the end of the action says what it leads to.
    """
    fields = _goal_first(packed)
    found = _graph(packed, fields, deadline)
    rest = [field for field in fields if not field & packed.freedom]
    if found is not None or rest == fields:
        return found
    return _graph(packed, rest, deadline)


def partial_graph(packed: PackedTask, deadline: Deadline) -> Projected:
    """The human's graph over as many of their private fields as stay tractable by their numbers of values."""
    found = _graph(packed, _tractable(packed, _goal_first(packed)), deadline)
    assert found is not None, "there are no more states than values together"
    return found


def _goal_first(packed: PackedTask) -> list[int]:
    """The human's private fields, those first that the goal asks for; last of all how far actions are."""

    def order(field: int) -> tuple[bool, bool, int]:
        return bool(field & packed.freedom), not field & packed.goal.mask, field

    return sorted(private_fields(packed), key=order)


def _tractable(packed: PackedTask, fields: Sequence[int]) -> list[int]:
    """Of some fields the first, as long as they have no more values together than a graph may have states."""
    sizes = accumulate((len(packed.values(field)) for field in fields), mul)
    return [field for field, size in zip(fields, sizes, strict=True) if size <= _MAX_STATES]


def alone_projection(packed: PackedTask, deadline: Deadline) -> PatternDatabase | None:
    """Costs to the human's goal alone in all that they change themselves; None where that is too much.

    What a script changes alone, and how far actions have come, is left out; what it changes of theirs, or
    others who are at something, may come at any time, for nothing.  A state that is not listed is one that
    they don't come by without others: nothing is known of it.
    """
    fields = [field for field in packed.fields if field & set_by(packed.own_forms) & packed.lasting]
    free = forms_of(packed.scripted, packed.all_ones, deadline)
    graph = _graph(packed, fields, deadline, packed.own_forms, free)
    return None if graph is None else own_projection(packed, graph, deadline)


def _graph(
    packed: PackedTask,
    fields: list[int],
    deadline: Deadline,
    forms: Iterable[Signature] | None = None,
    free: Iterable[Signature] = (),
) -> Projected | None:
    """The human's graph over some fields; None where it has too many states.

    Args:
        forms: of their actions; None for all of them.
        free: of what comes for nothing.
    """
    weights = own_weights(packed)
    forms = (*packed.own_forms, *packed.joint_forms) if forms is None else forms
    # The cheapest last, so that it stays where forms look alike.
    dearest_first = sorted(forms, key=lambda form: -form.cost)
    weighed = [*((form, weights[form.cost]) for form in dearest_first), *((form, 0) for form in free)]
    mask, most = sum(fields), _MAX_STATES if _tractable(packed, fields) == fields else _FEW_STATES
    return _explore(mask, packed.init & mask, _transitions(fields, weighed, deadline), most, deadline)


def _satisfying(graph: Projected, goal: PackedGoal) -> list[tuple[int, int]]:
    """The projected states of which some state may satisfy the goal, each at no distance from it."""
    if goal.need < 0:
        return []
    holds = goal.within(graph.mask).holds
    return [(0, state) for state in graph.moves if holds(state)]


class Transition(NamedTuple):
    """An op seen through the projection."""

    need_mask: int
    need: int
    keep: int
    put: int
    forbidden: Literals
    weight: int


def _explore(
    mask: int, start: int, steps: OperatorIndex[Transition], most: int, deadline: Deadline
) -> Projected | None:
    """The graph of projected states that are reached from ``start``; None if they are more than ``most``."""
    moves: Predecessors = {start: []}
    pending = [start]
    while pending:
        state = pending.pop()
        deadline.tick()
        edges: dict[int, tuple[int, int]] = {}  # of equal ones, what they lead to keeps the same
        for need_mask, need, keep, put, forbidden, weight in steps.candidates(state):
            after = state & keep | put
            if state & need_mask != need or after == state:
                continue
            if forbidden and any(state & field == value for field, value in forbidden):
                continue
            if after not in moves:
                if len(moves) >= most:
                    return None
                moves[after] = []
                pending.append(after)
            edge = edges.get(weight)
            if edge is None:
                edge = edges[weight] = weight, state
            moves[after].append(edge)
    return Projected(mask, moves)


def _transitions(
    fields: Sequence[int], forms: Iterable[tuple[Signature, int]], deadline: Deadline
) -> OperatorIndex[Transition]:
    """Ops in a projection, from their forms, the cheapest last; of those that look alike the cheapest."""
    mask = sum(fields)
    merged: dict[tuple[int, int], dict[tuple[int, int, Literals], int]] = {}
    for form, weight in forms:
        deadline.check()
        if form.sets & mask:
            shape = form.need_mask & mask, mask & ~form.sets
            merged.setdefault(shape, {}).update(_seen(form, mask, weight))
    asked = ((need_mask, len(values)) for (need_mask, _), values in merged.items())
    steps: OperatorIndex[Transition] = OperatorIndex(most_asked(fields, asked))
    for (need_mask, keep), values in merged.items():
        for (need, put, forbidden), weight in values.items():
            deadline.tick()
            steps.add(need_mask, need, Transition(need_mask, need, keep, put, forbidden, weight))
    return steps


def _seen(form: Signature, mask: int, weight: int) -> dict[tuple[int, int, Literals], int]:
    """Preconditions and effects of a form's ops in some fields, with their weight."""
    if not form.forbids & mask:
        return {(op.need & mask, op.put & mask, ()): weight for op in form.ops}
    return {
        (op.need & mask, op.put & mask, tuple((m, v) for m, v in op.forbidden if m & mask)): weight
        for op in form.ops
    }
