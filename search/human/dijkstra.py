"""Shortest distances against the direction of edges."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from heapq import heapify, heappop, heappush
from typing import TypeVar

from serendipity.model.deadline import Deadline

Place = TypeVar("Place", bound=Hashable)


def backward(
    sources: Iterable[tuple[int, Place]],
    edges: Sequence[Mapping[Place, Sequence[tuple[int, Place]]]],
    deadline: Deadline,
) -> dict[Place, int]:
    """Dijkstra's algorithm, a whole level of equal distance at a time: most distances recur.

    Args:
        sources: where it starts, each with a distance to begin with.
        edges: of each kind, per place what leads to it: the weight, and from where.
        deadline: asked for time.

    Returns:
        The least distance from each place from which a source can be reached.
    """
    levels: dict[int, list[Place]] = {}
    for distance, at in sources:
        levels.setdefault(distance, []).append(at)
    queue = list(levels)
    heapify(queue)
    found: dict[Place, int] = {}
    while queue:
        distance = heappop(queue)
        for at in levels.pop(distance):
            deadline.tick()
            if at in found:
                continue
            found[at] = distance
            for kind in edges:
                for weight, earlier in kind.get(at, ()):
                    if earlier not in found:
                        level = levels.get(distance + weight)
                        if level is None:
                            levels[distance + weight] = [earlier]
                            heappush(queue, distance + weight)
                        else:
                            level.append(earlier)
    return found
