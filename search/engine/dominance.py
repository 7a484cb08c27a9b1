"""Dominance: whoever can wait loses nothing by being somewhere early and at low cost."""

from collections.abc import Callable, Hashable
from operator import ge

Label = tuple[int, int, tuple[int, ...]]
"""Epoch, key, and for how long robots have been idle."""


class ParetoFront:
    """Non-dominated labels per state.

    Where everybody can wait, an earlier epoch at no higher key dominates, if robots have
    been idle for as long: then they do the same as much earlier.

    Args:
        no_worse: a further condition for the first key to dominate the second, for
            options under which keys alone do not tell (a limit on cost or window).
    """

    def __init__(self, no_worse: Callable[[int, int], bool] | None = None) -> None:
        self._labels: dict[Hashable, Label | list[Label]] = {}  # most states have but one
        self._no_worse = no_worse

    def add(self, state: Hashable, epoch: int, key: int, idle: tuple[int, ...] = ()) -> bool:
        """Record a label unless one already there dominates it; whether it was recorded."""
        label = epoch, key, idle
        known = self._labels.get(state)
        if known is None:
            self._labels[state] = label
            return True
        labels = [known] if isinstance(known, tuple) else known
        no_worse = self._no_worse
        for t, k, own in labels:  # twice as fast as a generator
            if t <= epoch and k <= key and all(map(ge, own, idle)) and (no_worse is None or no_worse(k, key)):
                return False
        if no_worse is None:
            labels = [
                (t, k, rest) for t, k, rest in labels if t < epoch or k < key or not all(map(ge, idle, rest))
            ]
        self._labels[state] = [*labels, label] if labels else label
        return True

    def alive(self, state: Hashable, epoch: int, key: int, idle: tuple[int, ...] = ()) -> bool:
        """Whether a recorded label has not been superseded since."""
        known = self._labels[state]
        label = epoch, key, idle
        return known == label if isinstance(known, tuple) else label in known
