"""Which fields to keep together: what the goal asks for, and what its changers ask for in turn."""

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import prod

from search.abstractions.projection import Field
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal

Neighbours = list[dict[int, int]]
"""Per field those that its changers ask for or set as well, and how many of them do."""


def patterns(
    fields: Sequence[Field], operators: Sequence[Operator], goal: PackedGoal, most_states: int
) -> list[tuple[Field, ...]]:
    """Sets of fields that have something to say of the goal, none twice.

    One is grown from each field of the goal; besides there are all single ones and pairs that can
    say more than their parts (Pommerening, Roeger and Helmert 2013).

    Args:
        fields: of the packed task.
        operators: the human's own.
        goal: what has to hold at the end.
        most_states: of a projection.
    """
    asked = _neighbours(fields, operators)
    goals = [i for i, field in enumerate(fields) if field.mask & goal.mask]
    grown = (_grown(start, fields, asked, most_states) for start in goals)
    small = (chosen for chosen in _small(goals, asked) if _size(chosen, fields) <= most_states)
    return [tuple(fields[i] for i in sorted(chosen)) for chosen in dict.fromkeys([*grown, *small])]


def _neighbours(fields: Sequence[Field], operators: Sequence[Operator]) -> Neighbours:
    shapes: dict[tuple[int, int], int] = {}
    for op in operators:
        shape = op.need_mask, op.keep
        shapes[shape] = shapes.get(shape, 0) + 1
    found: Neighbours = [{} for _ in fields]
    for (need_mask, keep), count in shapes.items():
        changed = [i for i, field in enumerate(fields) if field.mask & ~keep]
        asked = [i for i, field in enumerate(fields) if field.mask & need_mask]
        for i in changed:
            for j in {*changed, *asked} - {i}:
                found[i][j] = found[i].get(j, 0) + count
    return found


def _grown(start: int, fields: Sequence[Field], asked: Neighbours, most_states: int) -> frozenset[int]:
    """A field, and of those near it again and again the one that most changers ask for."""
    chosen, refused = {start}, set[int]()
    while True:
        near: dict[int, int] = {}
        for i in chosen:
            for j, count in asked[i].items():
                if j not in chosen and j not in refused:
                    near[j] = near.get(j, 0) + count
        if not near:
            return frozenset(chosen)
        best = max(near, key=lambda j: (near[j], -j))
        if _size({*chosen, best}, fields) > most_states:
            refused.add(best)
        else:
            chosen.add(best)


def _small(goals: Sequence[int], asked: Neighbours) -> Iterator[frozenset[int]]:
    for i in goals:
        yield frozenset([i])
        for j in asked[i]:
            yield frozenset([i, j])
    for i, j in combinations(goals, 2):
        if asked[i].keys() & asked[j].keys():
            yield frozenset([i, j])


def _size(chosen: frozenset[int] | set[int], fields: Sequence[Field]) -> int:
    return prod(fields[i].size for i in chosen)
