"""Places lie apart, connected ones of a floor plan share a wall, and nothing depends on chance."""

from itertools import combinations

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.pictures.map.layout import Box, MapLayout, corridor, floor_plan, lay_out
from serendipity.pictures.map.places import Places, find_places


def places_of(links: list[tuple[str, str]]) -> Places:
    return Places(tuple(sorted({place for link in links for place in link})), tuple(links))


@st.composite
def trees(draw: st.DrawFn) -> list[tuple[str, str]]:
    size = draw(st.integers(2, 40))
    return [(f"p{draw(st.integers(0, i - 1))}", f"p{i}") for i in range(1, size)]


@st.composite
def graphs(draw: st.DrawFn) -> list[tuple[str, str]]:
    links = draw(trees())
    names = sorted({place for link in links for place in link})
    pairs = st.tuples(st.sampled_from(names), st.sampled_from(names))
    extra = [(min(pair), max(pair)) for pair in draw(st.lists(pairs, max_size=30)) if len(set(pair)) == 2]
    return list(dict.fromkeys((min(link), max(link)) for link in links + extra))


def overlap(a: Box, b: Box) -> bool:
    inside = 1e-6
    across = min(a.right, b.right) - max(a.left, b.left)
    return across > inside and min(a.bottom, b.bottom) - max(a.top, b.top) > inside


def touch(a: Box, b: Box) -> bool:
    """Whether two boxes share a wall, and not just a corner."""
    beside = abs(abs(a.x - b.x) - (a.width + b.width) / 2) < 1e-6 and a.y == b.y
    above = abs(abs(a.y - b.y) - (a.height + b.height) / 2) < 1e-6
    return beside or (above and abs(a.x - b.x) < (a.width + b.width) / 2 - 1e-6)


def inside(layout: MapLayout) -> bool:
    boxes, slack = layout.boxes.values(), 1e-6
    inner = min(min(box.left, box.top) for box in boxes) >= -slack
    return inner and all(b.right <= layout.width + slack and b.bottom <= layout.height + slack for b in boxes)


@given(trees())
def test_rooms_of_a_tree_do_not_overlap_and_share_walls(links: list[tuple[str, str]]) -> None:
    layout = lay_out(places_of(links))
    assert inside(layout)
    assert layout.doors == frozenset(links)
    for a, b in combinations(layout.boxes, 2):
        assert not overlap(layout.boxes[a], layout.boxes[b]), (a, b)
    for a, b in links:
        assert touch(layout.boxes[a], layout.boxes[b]), (a, b)


@given(graphs())
def test_places_of_a_graph_do_not_overlap(links: list[tuple[str, str]]) -> None:
    layout = lay_out(places_of(links))
    assert inside(layout)
    for a, b in combinations(layout.boxes, 2):
        assert not overlap(layout.boxes[a], layout.boxes[b]), (a, b)


def test_figure_2_has_the_hall_as_corridor_and_the_rooms_beside_it() -> None:
    places = find_places(serendipity.example("room2"))
    tree = nx.Graph(places.links)
    halls = [f"hall{i}" for i in range(1, 9)]
    assert corridor(tree) == halls
    cells = floor_plan(tree)
    assert {place for place, cell in cells.items() if cell.corridor} == set(halls)
    assert [cells[hall].x for hall in halls] == sorted(cells[hall].x for hall in halls)
    assert cells["room4"].y * 2 == cells["room3"].y


def test_parts_that_no_way_connects_stand_side_by_side() -> None:
    layout = lay_out(places_of([("a", "b"), ("c", "d")]))
    boxes = layout.boxes
    assert max(boxes[place].right for place in "ab") < min(boxes[place].left for place in "cd")


def test_the_layout_of_a_graph_does_not_depend_on_chance() -> None:
    links = [("a", "b"), ("b", "c"), ("c", "a"), ("c", "d"), ("d", "e"), ("e", "a")]
    first, second = lay_out(places_of(links)), lay_out(places_of(links[::-1]))
    assert first.boxes == second.boxes


@pytest.mark.parametrize("links", [[("a", "b"), ("b", "c")], [("a", "b"), ("b", "c"), ("c", "a")]])
def test_routes_lead_from_middle_to_middle(links: list[tuple[str, str]]) -> None:
    layout = lay_out(places_of(links))
    for a, b in links:
        route = layout.route(a, b)
        assert route[0] == (layout.boxes[a].x, layout.boxes[a].y)
        assert route[-1] == (layout.boxes[b].x, layout.boxes[b].y)
        assert layout.route(b, a) == route[::-1]
