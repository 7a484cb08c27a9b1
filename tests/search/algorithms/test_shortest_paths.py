"""Distances in levels equal those by relaxing every edge."""

from hypothesis import given
from hypothesis import strategies as st

from search.engine.shortest_paths import LevelQueue, backward
from serendipity.model.resources.deadline import Deadline
from tests.search.engine.graphs import NODES, Edges, distances, graphs, turned

sources = st.dictionaries(st.integers(0, NODES - 1), st.integers(0, 3), min_size=1, max_size=3)


@given(first=graphs(), second=graphs(), sources=sources)
def test_distances_backward(first: Edges, second: Edges, sources: dict[int, int]) -> None:
    both = {node: first[node] + second[node] for node in first}
    kinds = [turned(first), turned(second)]
    found = backward(((distance, at) for at, distance in sources.items()), kinds, Deadline())
    assert found == distances(sources, turned(both))
    assert list(found.values()) == sorted(found.values())


@given(items=st.lists(st.tuples(st.integers(0, 5), st.integers())))
def test_levels_come_up_in_order(items: list[tuple[int, int]]) -> None:
    queue = LevelQueue(items[::2])
    for distance, item in items[1::2]:
        queue.push(distance, item)
    assert queue.least == min((distance for distance, _ in items), default=None)
    found = [(distance, item) for distance, level in queue for item in level]
    assert found == sorted(items[::2] + items[1::2], key=lambda pair: pair[0])
    assert queue.least is None


def test_what_is_added_to_the_level_in_hand_comes_next() -> None:
    queue = LevelQueue([(1, "a"), (3, "d")])
    met = []
    for distance, level in queue:
        for item in level:
            met.append((distance, item))
            if item == "a":
                queue.push(2, "c")
                queue.push(1, "b")
    assert met == [(1, "a"), (1, "b"), (2, "c"), (3, "d")]


@given(items=st.lists(st.integers(0, 5), min_size=1))
def test_of_equal_distances_the_latest_comes_first(items: list[int]) -> None:
    queue = LevelQueue(((distance, number) for number, distance in enumerate(items)))
    order = sorted(range(len(items)), key=lambda number: (items[number], -number))
    assert [queue.pop_latest() for _ in items] == order
    assert queue.least is None
