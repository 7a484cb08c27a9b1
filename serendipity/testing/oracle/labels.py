"""Labels of partial plans, and layers: the states after an epoch with their labels."""

from collections.abc import Callable, Iterable

from serendipity.testing.oracle.epochs import State

Label = tuple[int, int, int]
"""Objective without K, cost (both in the call's smallest unit of cost), number of actions."""

Front = tuple[Label, ...]
"""Labels of which none is worse in every completion than another."""

Layer = dict[State, Front]
Moves = Callable[[State], Iterable[tuple[State, Label]]]

NOTHING: Label = (0, 0, 0)


def plus(a: Label, b: Label) -> Label:
    """The label of two parts one after the other."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def front(labels: Iterable[Label]) -> Front:
    """Drop labels with an equal or smaller one in objective *and* cost.

    Cost has to be kept beside the objective because ``max_cost`` bounds it alone.
    """
    kept: list[Label] = []
    for label in sorted(set(labels)):
        if not kept or label[1] < kept[-1][1]:
            kept.append(label)
    return tuple(kept)


def advance(layer: Layer, moves: Moves) -> Layer:
    """The layer after one more epoch."""
    reached: dict[State, list[Label]] = {}
    for state, labels in layer.items():
        for next_state, step in moves(state):
            reached.setdefault(next_state, []).extend(plus(label, step) for label in labels)
    return {state: front(labels) for state, labels in reached.items()}
