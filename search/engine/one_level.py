"""A search that may end once no plan is as cheap as seemed possible at the start."""

from collections.abc import Callable, Iterable
from typing import Generic, TypeVar

from search.engine.best_first import Keyed, Progress, Space
from search.engine.few import EnoughError

N = TypeVar("N")
Best = TypeVar("Best", bound=Keyed)


class OneLevel(Generic[N, Best]):
    """A space whose bounds turn out to be as good as exact, or it is left.

    Args:
        space: the space.
        progress: of the search, which knows the bound.
        shift: keys without their lowest ``shift`` bits are objectives.
        leave: asked when bounds have risen, whether to end then.
    """

    def __init__(
        self, space: Space[N, Best], progress: Progress, shift: int, leave: Callable[[], bool]
    ) -> None:
        self._space = space
        self._progress = progress
        self._shift = shift
        self._leave = leave
        self._level: int | None = None
        self._stays = False

    def roots(self) -> Iterable[tuple[int, N]]:
        """See :class:`.Space`."""
        return self._space.roots()

    def alive(self, node: N) -> bool:
        """See :class:`.Space`."""
        return self._space.alive(node)

    def expand(self, node: N, best: Best) -> Iterable[tuple[int, N]]:
        """See :class:`.Space`.

        Raises:
            EnoughError: the bound has risen, and it is time to leave.
        """
        if not self._stays:
            level = self._progress.bound >> self._shift
            if self._level is None:
                self._level = level
            if level > self._level:
                if self._leave():
                    raise EnoughError
                self._stays = True
        return self._space.expand(node, best)
