"""Shortest paths, once for the verifier: Dijkstra from several sources, and A*.

Weights are integers of at least 0.  Of equally promising nodes the one that came first is looked at first.
"""

from collections.abc import Callable, Iterable, Iterator
from heapq import heapify, heappop, heappush
from typing import Generic, TypeVar

from serendipity.model import Deadline

N = TypeVar("N")
L = TypeVar("L")


def dijkstra(
    sources: Iterable[tuple[N, int]], edges: Callable[[N], Iterable[tuple[N, int]]], deadline: Deadline
) -> dict[N, int]:
    """Least distance of every node that can be reached from a source.

    Args:
        sources: different nodes, each with the distance that it starts with.
        edges: the nodes that follow a node, each with the edge's weight.
    """
    best = dict(sources)
    queue = [(distance, number, node) for number, (node, distance) in enumerate(best.items())]
    heapify(queue)
    number = len(queue)
    while queue:
        deadline.tick()
        distance, _, node = heappop(queue)
        if distance > best[node]:
            continue
        for after, weight in edges(node):
            total, known = distance + weight, best.get(after)
            if known is None or total < known:
                best[after] = total
                number += 1
                heappush(queue, (total, number, after))
    return best


class PathSearch(Generic[N, L]):
    """A* as an iteration: nodes in the order of distance and estimate, until the caller has seen enough.

    With a consistent estimate every node comes once, at its least distance; with another one it comes
    again where a shorter path is found later.

    Args:
        edges: the nodes that follow a node, each with the edge's weight and a label.
        estimate: what is left from a node, never too much; None where there is no way on.
        below: nodes whose distance and estimate add up to this, or more, are left out; None: none is.

    Attributes:
        distance: of every node that was met, so far.
    """

    def __init__(
        self,
        start: N,
        edges: Callable[[N], Iterable[tuple[N, int, L]]],
        estimate: Callable[[N], int | None],
        deadline: Deadline,
        below: int | None = None,
    ) -> None:
        self._start = start
        self._edges = edges
        self._estimate = estimate
        self._deadline = deadline
        self._below = below
        self._came_from: dict[N, tuple[N, L]] = {}
        self.distance: dict[N, int] = {start: 0}

    def __iter__(self) -> Iterator[tuple[N, int]]:
        """Nodes, each with its distance and estimate; a node's edges are looked at after it was taken."""
        edges, estimate, below = self._edges, self._estimate, self._below
        best, came_from = self.distance, self._came_from
        left = estimate(self._start)
        queue = [] if left is None or (below is not None and left >= below) else [(left, 0, 0, self._start)]
        number = 0
        while queue:
            self._deadline.check()
            least, minus, _, node = heappop(queue)
            if -minus > best[node]:
                continue
            yield node, least
            for after, weight, label in edges(node):
                total, known = weight - minus, best.get(after)
                if known is None or total < known:
                    left = estimate(after)
                    if left is not None and (below is None or total + left < below):
                        best[after] = total
                        came_from[after] = node, label
                        number += 1
                        heappush(queue, (total + left, -total, number, after))

    def path(self, node: N) -> list[L]:
        """The labels of the edges on the way to a node, in order."""
        labels = []
        while node in self._came_from:
            node, label = self._came_from[node]
            labels.append(label)
        return labels[::-1]
