"""Labels of partial plans, and layers: the states after an epoch with their labels."""

from collections.abc import Callable, Hashable, Iterable
from typing import TypeVar

Label = tuple[int, int, int, int, int]
"""Objective without K, cost, number of actions, what the human pays, and how much they are disturbed.

The last two are 0 where they are not limited; all but the number are in the call's smallest unit of cost.
"""

Front = tuple[Label, ...]
"""Labels of which none is worse in every completion than another."""

S = TypeVar("S", bound=Hashable)
"""States, or what else there may be between two epochs."""

Layer = dict[S, Front]
Moves = Callable[[S], Iterable[tuple[S, Label]]]

NOTHING: Label = (0, 0, 0, 0, 0)


def plus(a: Label, b: Label) -> Label:
    """The label of two parts one after the other."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4])


def front(labels: Iterable[Label]) -> Front:
    """Drop labels with an equal or smaller one in objective, cost *and* what the human pays and is disturbed.

    These have to be kept beside the objective because they are bounded alone.
    """
    kept: list[Label] = []
    for label in sorted(set(labels)):
        _, cost, _, paid, disturbed = label
        for known in kept:  # a loop: this is asked for millions of labels
            if known[1] <= cost and known[3] <= paid and known[4] <= disturbed:
                break
        else:
            kept.append(label)
    return tuple(kept)


def advance(layer: Layer[S], moves: Moves[S]) -> Layer[S]:
    """The layer after one more epoch."""
    reached: dict[S, list[Label]] = {}
    for state, labels in layer.items():
        for next_state, step in moves(state):
            reached.setdefault(next_state, []).extend(plus(label, step) for label in labels)
    return {state: front(labels) for state, labels in reached.items()}
