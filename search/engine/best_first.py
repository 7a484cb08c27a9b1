"""The best-first loop that serves every mode: a mode is a space and a bound.

Keys are those of ``search.packed.cost_vector``: one comparison orders objective, cost, window,
start and length at once, so the first proof is already the answer of semantics 3.1.
"""

from collections.abc import Generator, Iterable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from search.engine.shortest_paths import LevelQueue
from serendipity.model.resources.deadline import Deadline

_PATIENCE = 1.25
"""Reports of the bound are this factor apart in time: a few dozen in all."""


class Node(NamedTuple):
    """A search node: the agents have acted in epochs ``1 .. epoch``."""

    key: int
    epoch: int
    state: int
    phase: int
    start: int
    """First epoch of the window, 0 while it has not been opened."""
    parent: "Node | None"
    actions: tuple[int, ...]
    """What was done in ``epoch``."""
    idle: tuple[int, ...] = ()
    """For how long robots have been idle, where their walks are folded."""


@dataclass(slots=True)
class Incumbent:
    """The best complete plan so far.

    Attributes:
        key: its key, or ``INFINITE_KEY`` where there is none.
        node: the last node before the suffix, or None for the answer that was there first.
        end: first epoch of the suffix (``xi2``), 0 without a window.
        tail: actions of the human after ``node``, one an epoch.
    """

    key: int
    node: Node | None = None
    end: int = 0
    tail: tuple[int, ...] = ()


@dataclass(slots=True)
class Progress:
    """The counts of a search at any moment, and its bound: no complete plan has a smaller key."""

    bound: int = 0
    expanded: int = 0
    generated: int = 0
    told: int = 0
    """The bound when it was last reported."""
    told_at: float = 0.01
    """Seconds by the deadline when it was; short searches don't report theirs."""

    def due(self, deadline: Deadline) -> bool:
        """Whether the bound has risen, and long enough after it was last reported."""
        if self.bound <= self.told or (now := deadline.elapsed()) < _PATIENCE * self.told_at:
            return False
        self.told, self.told_at = self.bound, now
        return True


class Space(Protocol):
    """The search space of a mode: its nodes, and how they lead to a better incumbent."""

    def roots(self) -> Iterable[tuple[int, Node]]:
        """Bounded initial nodes."""

    def alive(self, node: Node) -> bool:
        """Whether no better node makes this one superfluous."""

    def expand(self, node: Node, best: Incumbent) -> Iterable[tuple[int, Node]]:
        """Bounded successors; complete plans met on the way are offered to ``best``."""


class Ties(NamedTuple):
    """For how many nodes a search goes on once the best objective, a key without low bits, is proved."""

    shift: int
    nodes: int


def best_first(
    space: Space,
    best: Incumbent,
    progress: Progress,
    deadline: Deadline,
    ties: Ties | None = None,
    most: int = 0,
) -> Generator[None, None, bool]:
    """Yield for each better incumbent, and now and then where the bound has risen.

    Of nodes with equal bounds the latest comes first.  On return ``best`` is optimal and the bound is
    its key, but for what ``ties`` leaves open.

    Args:
        space: what is searched.
        best: the incumbent, which is made better.
        progress: what is known so far, which is brought up to date.
        ties: how far incumbents of the best objective are told apart; None: all the way.
        most: after so many nodes it ends, whatever has been found; 0: never.

    Returns:
        Whether it ended for that.

    Raises:
        LimitReachedError: the deadline ran out; ``best`` and ``progress.bound`` hold what is known.
    """
    queue = LevelQueue(space.roots())
    last = progress.expanded + most
    known, left = best.key, 0 if ties is None else ties.nodes
    while (bound := queue.least) is not None and bound < best.key:
        node = queue.pop_latest()
        progress.bound = max(progress.bound, bound)
        if not space.alive(node):
            continue
        deadline.check()
        if ties is not None and progress.bound >> ties.shift >= best.key >> ties.shift:
            if not left:
                return False
            left -= 1
        progress.expanded += 1
        if most and progress.expanded > last:
            return True
        for child_bound, child in space.expand(node, best):
            deadline.tick()
            progress.generated += 1
            if child_bound < best.key:
                queue.push(child_bound, child)
        if best.key < known or progress.due(deadline):
            known = best.key
            yield
    progress.bound = best.key
    return False


def solve_space(space: Space, best: Incumbent, deadline: Deadline) -> Incumbent:
    """The incumbent once :func:`best_first` has come to its end; see there."""
    for _ in best_first(space, best, Progress(), deadline):
        pass
    return best
