"""Shortest paths by Dijkstra's algorithm, a whole level of equal distance at a time.

Few costs differ in a planning task, so most distances recur.  The queue is therefore a heap of
distances, each of which is there once, with a list of what lies at it.
"""

from collections.abc import Container, Hashable, Iterable, Iterator, Mapping, Sequence
from heapq import heappop, heappush
from typing import Generic, TypeVar

from serendipity.model.resources.deadline import Deadline

Item = TypeVar("Item")
State = TypeVar("State", bound=Hashable)


class LevelQueue(Generic[Item]):
    """A priority queue of what is still to be settled, by its distance.

    Iterating takes one level after another out of the queue, by ascending distance, until none is
    left; what is pushed meanwhile comes in its turn.  An item comes up as often as it was pushed, in
    the order in which it was: whoever iterates looks whether it has been settled.  Where each weight
    is above 0 nothing is added to a level that has come up; otherwise what is added to it comes up
    next, as a level of its own.

    Args:
        items: what is there from the start, with its distance.

    Attributes:
        levels: the items by distance; only :meth:`push` may add a distance.
    """

    __slots__ = ("_distances", "levels")

    def __init__(self, items: Iterable[tuple[int, Item]] = ()) -> None:
        self.levels: dict[int, list[Item]] = {}
        for distance, item in items:
            self.levels.setdefault(distance, []).append(item)
        self._distances = sorted(self.levels)

    def push(self, distance: int, item: Item) -> None:
        """Add an item."""
        level = self.levels.get(distance)
        if level is None:
            self.levels[distance] = [item]
            heappush(self._distances, distance)
        else:
            level.append(item)

    def relax(self, distance: int, edges: Iterable[tuple[int, Item]], settled: Container[Item]) -> None:
        """Add where edges lead from something at a distance, but for what is settled."""
        for weight, item in edges:
            if item not in settled:
                self.push(distance + weight, item)

    @property
    def least(self) -> int | None:
        """The least distance that has not come up; None where the queue is empty."""
        return self._distances[0] if self._distances else None

    def pop(self) -> tuple[int, list[Item]]:
        """Take the level of the least distance out of the queue, which is not empty."""
        distance = heappop(self._distances)
        return distance, self.levels.pop(distance)

    def pop_latest(self) -> Item:
        """Take the item out of the queue, which is not empty, that came last to the least distance."""
        distance = self._distances[0]
        level = self.levels[distance]
        item = level.pop()
        if not level:
            self.pop()
        return item

    def __iter__(self) -> Iterator[tuple[int, list[Item]]]:
        distances, levels = self._distances, self.levels
        while distances:
            distance = heappop(distances)
            yield distance, levels.pop(distance)


def backward(
    sources: Iterable[tuple[int, State]],
    edges: Sequence[Mapping[State, Sequence[tuple[int, State]]]],
    deadline: Deadline,
) -> dict[State, int]:
    """Shortest distances against the direction of edges.

    Args:
        sources: where it starts, each with a distance to begin with.
        edges: of each kind, per state what leads to it: the weight (at least 0), and from where.

    Returns:
        The least distance from each state from which a source can be reached, ascending.
    """
    queue = LevelQueue(sources)
    found: dict[State, int] = {}
    for distance, states in queue:
        for at in states:
            deadline.tick()
            if at in found:
                continue
            found[at] = distance
            for kind in edges:
                queue.relax(distance, kind.get(at, ()), found)
    return found
