"""Least weights in small graphs, found in the plainest way."""

from collections.abc import Iterable, Mapping
from heapq import heappop, heappush
from typing import Any


def distances(sources: Iterable[Any], edges: Mapping[Any, Iterable[tuple[int, Any]]]) -> dict[Any, int]:
    """The least weight of a way to each node from any of some nodes.

    Args:
        sources: where ways begin.
        edges: by node, weights and where they lead to.
    """
    queue, found = [(0, node) for node in sources], dict[Any, int]()
    while queue:
        spent, node = heappop(queue)
        if node not in found:
            found[node] = spent
            for weight, after in edges.get(node, ()):
                heappush(queue, (spent + weight, after))
    return found
