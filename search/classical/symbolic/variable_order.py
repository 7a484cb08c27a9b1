"""The order of variables in decision diagrams: what depends on one another is close together.

Kissmann and Hoffmann, BDD Ordering Heuristics for Classical Planning (2014), after Gamer: the sum of
squared distances between variables of the causal graph, made smaller by exchanging two at a time.
"""

from collections.abc import Sequence
from itertools import combinations
from random import Random
from typing import Final

from search.packed.operators import Operator, asked_by

_TRIES: Final = 400
"""Exchanges that are tried for each variable."""


def variable_order(fields: Sequence[int], operators: Sequence[Operator]) -> list[int]:
    """The numbers of fields, given by their masks, in the order of their variables; always the same."""
    beside = _causal_graph(fields, operators)
    draw, order = Random(0), [*range(len(fields))]
    draw.shuffle(order)
    place = [order.index(number) for number in range(len(fields))]
    for _ in range(_TRIES * len(order)):
        i, j = draw.randrange(len(order)), draw.randrange(len(order))
        a, b = order[i], order[j]
        change = sum((j - place[c]) ** 2 - (i - place[c]) ** 2 for c in beside[a] if c != b)
        change += sum((i - place[c]) ** 2 - (j - place[c]) ** 2 for c in beside[b] if c != a)
        if change < 0:
            order[i], order[j], place[a], place[b] = b, a, j, i
    return order


def _causal_graph(fields: Sequence[int], operators: Sequence[Operator]) -> list[set[int]]:
    """Per field those that some operator sets with it, or asks for where it sets the other."""
    beside: list[set[int]] = [set() for _ in fields]
    shapes = {(~op.keep, asked_by(op)) for op in operators}
    for sets, asks in shapes:
        touched = [number for number, field in enumerate(fields) if field & (sets | asks)]
        for a, b in combinations(touched, 2):
            if (fields[a] | fields[b]) & sets:
                beside[a].add(b)
                beside[b].add(a)
    return beside
