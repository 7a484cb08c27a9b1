"""A* finds least costs, with any consistent estimate, below its limit and in a known order."""

from hypothesis import given
from hypothesis import strategies as st

from search.engine.astar import AStar
from serendipity.model.resources.deadline import Deadline
from tests.shortest import distances

Edges = dict[int, list[tuple[int, int]]]
"""Per node what leads on from it: weight, and where to."""

NODES, FAR = 7, 1000


def graphs(least: int = 0) -> st.SearchStrategy[Edges]:
    """Graphs of a few nodes with weights from ``least`` on."""
    edge = st.tuples(st.integers(least, 4), st.integers(0, NODES - 1))
    return st.fixed_dictionaries({node: st.lists(edge, max_size=4) for node in range(NODES)})


def turned(edges: Edges) -> Edges:
    found: Edges = {}
    for node, onward in edges.items():
        for weight, after in onward:
            found.setdefault(after, []).append((weight, node))
    return found


def estimates(edges: Edges, goal: int, share: int) -> dict[int, int]:
    """A consistent estimate of the way to a goal: a share (in quarters) of the distance, rounded up."""
    exact = distances([goal], turned(edges))
    return {node: -(-exact.get(node, FAR) * share // 4) for node in range(NODES)}


@given(graphs(), st.integers(0, NODES - 1), st.integers(0, 4), st.booleans(), st.integers(1, 12))
def test_least_costs_below_the_limit(
    edges: Edges, goal: int, share: int, deep_first: bool, limit: int
) -> None:
    estimate, exact = estimates(edges, goal, share), distances([0], edges)
    search = AStar(0, estimate.__getitem__, Deadline(), limit=limit, deep_first=deep_first)
    met = {}
    for node, spent in search:
        assert node not in met
        met[node] = spent
        for weight, after in edges[node]:
            search.reach(after, spent + weight, node)
    assert met == {node: cost for node, cost in exact.items() if node in met}
    if exact.get(goal, FAR) < limit:
        assert goal in met
    assert search.least is None or search.least >= limit


@given(graphs(), st.integers(0, NODES - 1), st.booleans())
def test_the_limit_may_be_lowered(edges: Edges, goal: int, deep_first: bool) -> None:
    estimate, exact = estimates(edges, goal, 4), distances([0], edges)
    search = AStar(0, estimate.__getitem__, Deadline(), limit=FAR, deep_first=deep_first)
    for node, spent in search:
        if node == goal:
            search.limit = spent
        for weight, after in edges[node]:
            search.reach(after, spent + weight, node, weight)
    assert search.limit == exact.get(goal, FAR)
    if search.limit < FAR:
        way = list(search.way_back(goal))
        assert sum(weight for _, weight in way) == search.limit
        assert [node for node, _ in way][-1:] == [0] * (goal != 0)


def test_ties_go_by_what_has_been_spent_and_by_the_state() -> None:
    for deep_first, expected in ((True, [0, 2, 3, 1]), (False, [0, 1, 2, 3])):
        search = AStar(0, {0: 3, 1: 2, 2: 1, 3: 1}.__getitem__, Deadline(), limit=9, deep_first=deep_first)
        met = []
        for node, _ in search:
            met.append(node)
            if not node:
                for spent, after in ((2, 3), (1, 1), (2, 2)):
                    search.reach(after, spent, node)
        assert met == expected
