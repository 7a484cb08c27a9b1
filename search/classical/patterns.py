"""Patterns, sets of fields to keep together: of the goal, and of what its changers ask for in turn."""

from collections.abc import Iterator, Sequence
from itertools import chain, combinations
from math import prod

from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal
from serendipity.model import Deadline

StateField = tuple[int, int]
"""Mask of a field, and how many values it has."""

Neighbours = list[dict[int, int]]
"""Per field those that its changers ask for or set as well, and how many of them do."""


def patterns(
    fields: Sequence[StateField],
    operators: Sequence[Operator],
    goal: PackedGoal,
    most_states: int,
    deadline: Deadline,
) -> Iterator[list[int]]:
    """Sets of fields that have something to say of the goal, none twice; each is worked out when asked for.

    Fields go by their places, ascending.  One set is grown from each field of the goal; besides there are
    all single ones and pairs that can say more than their parts (Pommerening, Roeger and Helmert 2013).
    """
    asked = _neighbours(fields, operators, deadline)
    goals = [i for i, (mask, _) in enumerate(fields) if mask & goal.mask]
    grown = (_grown(start, fields, asked, most_states) for start in goals)
    small = (chosen for chosen in _small(goals, asked, deadline) if _size(chosen, fields) <= most_states)
    seen = set()
    for chosen in chain(grown, small):
        if chosen not in seen:
            seen.add(chosen)
            yield sorted(chosen)


def _neighbours(
    fields: Sequence[StateField], operators: Sequence[Operator], deadline: Deadline
) -> Neighbours:
    shapes: dict[tuple[int, int], int] = {}
    for op in deadline.each(operators):
        shape = op.need_mask, op.keep
        shapes[shape] = shapes.get(shape, 0) + 1
    found: Neighbours = [{} for _ in fields]
    for (need_mask, keep), count in deadline.each(shapes.items()):
        changed = [i for i, (mask, _) in enumerate(fields) if mask & ~keep]
        asked = [i for i, (mask, _) in enumerate(fields) if mask & need_mask]
        for i in changed:
            for j in {*changed, *asked} - {i}:
                found[i][j] = found[i].get(j, 0) + count
    return found


def _grown(start: int, fields: Sequence[StateField], asked: Neighbours, most_states: int) -> frozenset[int]:
    """A field, and of those near it again and again the one that most changers ask for."""
    chosen, size = {start}, fields[start][1]
    near = dict(asked[start])
    done = {start}  # chosen, or too large
    while near:
        best = max(near, key=lambda j: (near[j], -j))
        del near[best]
        done.add(best)
        if size * fields[best][1] > most_states:
            continue
        chosen.add(best)
        size *= fields[best][1]
        for j, count in asked[best].items():
            if j not in done:
                near[j] = near.get(j, 0) + count
    return frozenset(chosen)


def _small(goals: Sequence[int], asked: Neighbours, deadline: Deadline) -> Iterator[frozenset[int]]:
    for i in goals:
        yield frozenset([i])
        for j in asked[i]:
            yield frozenset([i, j])
    for i, j in deadline.each(combinations(goals, 2)):
        if asked[i].keys() & asked[j].keys():
            yield frozenset([i, j])


def _size(chosen: frozenset[int] | set[int], fields: Sequence[StateField]) -> int:
    return prod(fields[i][1] for i in chosen)
