"""Small graphs, and distances in them by relaxing every edge until nothing changes (Bellman, Ford)."""

from collections.abc import Mapping

from hypothesis import strategies as st

Edges = dict[int, list[tuple[int, int]]]
"""Per node what leads on from it: weight, and where to."""

NODES = 7


def graphs(least: int = 0) -> st.SearchStrategy[Edges]:
    """Graphs of a few nodes with weights from ``least`` on."""
    edge = st.tuples(st.integers(least, 4), st.integers(0, NODES - 1))
    return st.fixed_dictionaries({node: st.lists(edge, max_size=4) for node in range(NODES)})


def turned(edges: Edges) -> Edges:
    """The same edges against their direction."""
    found: Edges = {}
    for node, onward in edges.items():
        for weight, after in onward:
            found.setdefault(after, []).append((weight, node))
    return found


def distances(sources: Mapping[int, int], edges: Edges) -> dict[int, int]:
    """The least distance of each node that a source leads to."""
    found = dict(sources)
    for _ in range(NODES):
        for node, onward in edges.items():
            for weight, after in onward:
                if node in found and found[node] + weight < found.get(after, 1000):
                    found[after] = found[node] + weight
    return found
