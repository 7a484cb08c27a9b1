"""A search that ends after some nodes, whatever it has found by then."""

from collections.abc import Iterable
from typing import Generic, TypeVar

from search.engine.best_first import Keyed, Space

N = TypeVar("N")
Best = TypeVar("Best", bound=Keyed)


class EnoughError(Exception):
    """As many nodes have been expanded as should be."""


class Few(Generic[N, Best]):
    """A space of which only some nodes are expanded.

    Args:
        space: the space.
        nodes: how many.
    """

    def __init__(self, space: Space[N, Best], nodes: int) -> None:
        self._space = space
        self._left = nodes

    def roots(self) -> Iterable[tuple[int, N]]:
        """See :class:`.Space`."""
        return self._space.roots()

    def alive(self, node: N) -> bool:
        """See :class:`.Space`."""
        return self._space.alive(node)

    def expand(self, node: N, best: Best) -> Iterable[tuple[int, N]]:
        """See :class:`.Space`.

        Raises:
            EnoughError: there have been enough.
        """
        if not self._left:
            raise EnoughError
        self._left -= 1
        return self._space.expand(node, best)
