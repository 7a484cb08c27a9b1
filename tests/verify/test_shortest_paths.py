"""The verifier's shortest paths are those that relaxing every edge often enough finds."""

import math

from hypothesis import given
from hypothesis import strategies as st

from serendipity.model import Deadline
from verify.base.shortest_paths import PathSearch, dijkstra

NODES = 6
Edges = list[tuple[int, int, int]]
"""From, to, weight."""

edges = st.lists(st.tuples(*[st.integers(0, NODES - 1)] * 2, st.integers(0, 9)), max_size=20)


def relaxed(start: int, graph: Edges) -> list[float]:
    best: list[float] = [math.inf] * NODES
    best[start] = 0
    for _ in range(NODES):
        for source, target, weight in graph:
            best[target] = min(best[target], best[source] + weight)
    return best


def finite(distances: list[float]) -> dict[int, float]:
    return {node: distance for node, distance in enumerate(distances) if distance < math.inf}


@given(edges, st.dictionaries(st.integers(0, NODES - 1), st.integers(0, 20), max_size=3))
def test_distances_from_several_sources(graph: Edges, sources: dict[int, int]) -> None:
    found = dijkstra(sources.items(), lambda node: [(t, w) for s, t, w in graph if s == node], Deadline())
    expected = [math.inf] * NODES
    for source, first in sources.items():
        expected = [min(a, first + b) for a, b in zip(expected, relaxed(source, graph), strict=True)]
    assert found == finite(expected)


@given(edges, st.lists(st.integers(0, 9), min_size=NODES, max_size=NODES), st.booleans())
def test_a_path_of_least_weight(graph: Edges, off: list[int], exact: bool) -> None:
    """Whether the estimate is exact, and so consistent, or anything that is not too much."""
    left = [relaxed(node, graph)[NODES - 1] for node in range(NODES)]

    def estimate(node: int) -> int | None:
        return None if left[node] == math.inf else max(0, int(left[node]) - (0 if exact else off[node]))

    search = PathSearch(
        0, lambda node: [(e[1], e[2], e) for e in graph if e[0] == node], estimate, Deadline()
    )
    found = next((node for node, _ in search if node == NODES - 1), None)
    assert (found is None) == (left[0] == math.inf)
    if found is not None:
        path = search.path(found)
        assert search.distance[found] == left[0] == sum(weight for _, _, weight in path)
        assert [s for s, _, _ in path] == [0, *(t for _, t, _ in path)][: len(path)]


@given(edges, st.integers(0, 30))
def test_what_is_too_far_is_left_out(graph: Edges, below: int) -> None:
    search = PathSearch(
        0,
        lambda node: [(t, w, None) for s, t, w in graph if s == node],
        lambda _: 0,
        Deadline(),
        below,
    )
    reached = {node: search.distance[node] for node, _ in search}
    assert reached == {node: far for node, far in finite(relaxed(0, graph)).items() if far < below}
