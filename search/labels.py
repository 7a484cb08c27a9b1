"""Dominance: who can wait is never worse off for being early and cheap."""

from collections.abc import Callable


class Labels:
    """Non-dominated (epoch, key) pairs per state.

    Where everybody can wait, an earlier epoch at no higher key dominates.

    Args:
        no_worse: a further condition for the first key to dominate the second, for
            options under which keys alone do not tell (a limit on cost or window).
    """

    def __init__(self, no_worse: Callable[[int, int], bool] | None = None) -> None:
        self._labels: dict[int, list[tuple[int, int]]] = {}
        self._no_worse = no_worse

    def add(self, state: int, epoch: int, key: int) -> bool:
        """Record a label unless one already there dominates it; whether it was recorded."""
        labels = self._labels.get(state)
        if labels is None:
            self._labels[state] = [(epoch, key)]
            return True
        if self._covered(labels, epoch, key):
            return False
        if self._no_worse is None:
            labels[:] = [label for label in labels if label[0] < epoch or label[1] < key]
        labels.append((epoch, key))
        return True

    def alive(self, state: int, epoch: int, key: int) -> bool:
        """Whether a recorded label has not been superseded since."""
        return (epoch, key) in self._labels[state]

    def _covered(self, labels: list[tuple[int, int]], epoch: int, key: int) -> bool:
        no_worse = self._no_worse
        if no_worse is None:
            return any(t <= epoch and k <= key for t, k in labels)
        return any(t <= epoch and k <= key and no_worse(k, key) for t, k in labels)
