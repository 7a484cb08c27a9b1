"""A search that ends before it is done, whatever it has found by then."""

from collections.abc import Callable, Iterable
from typing import Generic, TypeVar

from search.engine.best_first import Keyed, Progress, Space

N = TypeVar("N")
Best = TypeVar("Best", bound=Keyed)


class EnoughError(Exception):
    """It has gone on for long enough."""


class Until(Generic[N, Best]):
    """A space that is expanded for a while only.

    Args:
        space: the space.
        is_enough: asked before each node.
    """

    def __init__(self, space: Space[N, Best], is_enough: Callable[[], bool]) -> None:
        self._space = space
        self._is_enough = is_enough

    def roots(self) -> Iterable[tuple[int, N]]:
        """See :class:`.Space`."""
        return self._space.roots()

    def alive(self, node: N) -> bool:
        """See :class:`.Space`."""
        return self._space.alive(node)

    def expand(self, node: N, best: Best) -> Iterable[tuple[int, N]]:
        """See :class:`.Space`.

        Raises:
            EnoughError: it has been enough.
        """
        if self._is_enough():
            raise EnoughError
        return self._space.expand(node, best)


def few(nodes: int) -> Callable[[], bool]:
    """Enough after so many nodes."""
    left = iter(range(nodes))
    return lambda: next(left, None) is None


def risen(progress: Progress, shift: int, and_then: Callable[[], bool]) -> Callable[[], bool]:
    """Enough once no plan is as good as seemed possible at the start.

    Args:
        progress: of the search, which knows the bound.
        shift: keys without their lowest ``shift`` bits are objectives.
        and_then: asked then, once, whether it is enough indeed.
    """
    first: int | None = None
    is_settled = False

    def is_enough() -> bool:
        nonlocal first, is_settled
        if is_settled:
            return False
        level = progress.bound >> shift
        first = level if first is None else first
        is_settled = level > first
        return is_settled and and_then()

    return is_enough
