"""The map is derived from what agents can do, and from the names of facts.

Places lie apart, connected ones of a floor plan share a wall; labels lie apart within them.
"""

import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import combinations, pairwise, permutations
from pathlib import Path

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Task
from serendipity.pictures import Scene, build_scene, draw
from serendipity.pictures.formats.svg import svg
from serendipity.pictures.map.layout import Box, MapLayout, corridor, floor_plan, lay_out
from serendipity.pictures.map.places import Places, Whereabouts, find_places
from serendipity.pictures.picture.map_picture import MARGIN, map_picture
from serendipity.pictures.scene.scene import Meeting
from serendipity.scenarios.usar import figure2
from serendipity_testing import cases
from serendipity_testing.builders import task as build
from serendipity_testing.builders import usar
from tests.show.conftest import ground, spaced, walk
from tests.show.drawn import SVG, Drawn, drawn_tokens


def test_figure_2_is_found_as_it_was_written() -> None:
    places = find_places(serendipity.example("room2"))
    building = figure2()
    assert set(places.names) == set(building.locations)
    assert {frozenset(link) for link in places.links} == {frozenset(pair) for pair in building.connections}
    assert len(places.links) == len(building.connections)
    assert sorted(places.objects) == ["mk1", "mk2"]


def test_names_are_sorted_as_people_count() -> None:
    names = find_places(serendipity.example("room2")).names
    assert names.index("room2") < names.index("room10")


def test_places_may_share_the_beginning_of_their_names() -> None:
    task = usar(
        "cell_1-cell_2-cell_3",
        human="cell_1",
        robots={"rob": "cell_3"},
        kits={"k": "cell_2"},
        triage="cell_3",
    )
    assert find_places(task).names == ("cell_1", "cell_2", "cell_3")
    assert find_places(ground(task)).names == ("cell_1", "cell_2", "cell_3")


def test_an_object_is_in_a_place_or_held() -> None:
    task = cases.case_8()
    told = find_places(task).objects["k"]
    said = {task.facts[f]: where for f, where in told.items()}
    assert said["at k b"] == Whereabouts(place="b")
    assert said["has rob k"] == Whereabouts(holder=task.agents.index("rob"))


def test_tasks_without_moves_have_no_map() -> None:
    for task in (cases.case_6(), cases.case_9(), cases.case_10()):
        assert find_places(task).names == ()


def _pushing() -> Task:
    """A human pushes a crate along a row of cells; free cells are facts of their own."""
    cells = ["c1", "c2", "c3", "c4"]
    actions = {}
    for a, b in [*pairwise(cells), *pairwise(cells[::-1])]:
        actions[f"walk h {a} {b}"] = f"at_h_{a} free_{b} -> at_h_{b} free_{a} !at_h_{a} !free_{b}"
    for a, b, c in zip(cells, cells[1:], cells[2:], strict=False):
        effects = f"at_h_{b} at_crate_{c} free_{a} !at_h_{a} !at_crate_{b} !free_{c}"
        actions[f"push h {a} {b} {c}"] = f"at_h_{a} at_crate_{b} free_{c} -> {effects}"
    return spaced(build(init="at_h_c1 at_crate_c2 free_c3 free_c4", goal="at_crate_c4", actions=actions))


def test_a_crate_that_is_pushed_is_no_agent() -> None:
    task = _pushing()
    places = find_places(task)
    assert list(places.positions) == [0]
    assert {task.facts[f] for f in places.positions[0]} == {f"at h c{i}" for i in range(1, 5)}
    assert list(places.objects) == ["crate"]


def test_who_rides_is_where_the_vehicle_is() -> None:
    actions = walk("h", "p-q")
    for a, b in ("pq", "qp"):
        actions[f"drive h {a} {b}"] = f"in_h_car at_car_{a} -> at_car_{b} !at_car_{a}"
        actions[f"enter h {a}"] = f"at_h_{a} at_car_{a} -> in_h_car !at_h_{a}"
        actions[f"leave h {a}"] = f"in_h_car at_car_{a} -> at_h_{a} !in_h_car"
    task = spaced(build(init="at_h_p at_car_p", goal="at_h_q", actions=actions))
    places = find_places(task)
    assert {task.facts[f]: name for f, name in places.riding[0].items()} == {"in h car": "car"}


def test_the_place_may_stand_before_the_agent() -> None:
    actions = {
        f"walk {who} {a} {b}": f"holds_{a}_{who} -> holds_{b}_{who} !holds_{a}_{who}"
        for who in "hr"
        for a, b in ("pq", "qp")
    }
    task = build(init="holds_p_h holds_q_r", goal="holds_q_h", actions=actions)
    places = find_places(spaced(task))
    assert places.names == ("p", "q")
    assert sorted(places.positions) == [0, 1]


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


H = 0


def lorry(loads: int) -> Task:
    """A driver, a lorry and things to load, all in one place; the first is wanted in the other."""
    things = [f"consignment{i}" for i in range(1, loads + 1)]
    actions = walk("h", "west-east")
    for a, b in permutations(("west", "east")):
        actions[f"drive h {a} {b}"] = f"in_h_lorry at_lorry_{a} -> at_lorry_{b} !at_lorry_{a}"
        actions[f"enter h {a}"] = f"at_h_{a} at_lorry_{a} -> in_h_lorry !at_h_{a}"
        actions[f"leave h {a}"] = f"in_h_lorry at_lorry_{a} -> at_h_{a} !in_h_lorry"
        for thing in things:
            near, there, loaded = f"in_h_lorry at_lorry_{a}", f"at_{thing}_{a}", f"in_{thing}_lorry"
            actions[f"load h {thing} {a}"] = f"{near} {there} -> {loaded} !{there}"
            actions[f"unload h {thing} {a}"] = f"{near} {loaded} -> {there} !{loaded}"
    init = " ".join(["at_h_west at_lorry_west", *(f"at_{thing}_west" for thing in things)])
    return spaced(build(init=init, goal="at_consignment1_east", actions=actions))


def played(task: Task) -> Scene:
    return build_scene(task, serendipity.plan(task, mode="individual"))


def kept_apart(scene: Scene, epoch: int) -> dict[str, Drawn]:
    """The tokens of an epoch, none of which overlaps another or its place's name, or leaves its place."""
    sheet, tokens = drawn_tokens(scene, epoch)
    frames = {key: token for key, token in tokens.items() if key.startswith("frame-")}
    single = {key: token for key, token in tokens.items() if key not in frames}
    for (one, a), (other, b) in combinations(single.items(), 2):
        assert not a.overlaps(b), (epoch, one, other)
    for frame, outline in frames.items():
        for key, token in tokens.items():
            apart = not outline.overlaps(token)
            assert apart or outline.encloses(token) or token.encloses(outline), (epoch, frame, key)
    for key, token in tokens.items():
        assert sheet.encloses(token), (epoch, key)
        boxes = (box.moved(MARGIN, MARGIN) for box in scene.layout.boxes.values())
        within = (Drawn(box.left, box.top + 25, box.right, box.bottom, "", "") for box in boxes)
        assert any(room.encloses(token) for room in within), (epoch, key)
    return tokens


@pytest.mark.parametrize("name", ["room2", "parcels", "flights", "taxis", "morning", "office"])
def test_labels_lie_apart_and_within_their_places(name: str) -> None:
    task = serendipity.example(name)
    scene = build_scene(task, serendipity.plan(task, discount="0.5"))
    for frame in scene.frames:
        kept_apart(scene, frame.epoch)


@pytest.mark.parametrize("loads", [6, 60])
def test_places_grow_until_everything_in_them_is_named(loads: int) -> None:
    scene = played(lorry(loads))
    for frame in scene.frames:
        shown = kept_apart(scene, frame.epoch)
        assert {f"object-{i}" for i in range(loads + 1)} <= shown.keys()
    assert all(box.height > 100 for box in scene.layout.boxes.values())


def test_who_drives_and_what_is_loaded_are_in_the_frame_of_the_lorry() -> None:
    scene = played(lorry(3))
    names = list(scene.frames[0].objects)
    lorry_key, load_key = (f"object-{names.index(name)}" for name in ("lorry", "consignment1"))
    other = f"object-{names.index('consignment2')}"
    loaded = next(a.epoch for a in scene.acts if a.verb == "load")
    tokens = kept_apart(scene, loaded)
    frame = tokens[f"frame-{lorry_key}"]
    assert all(frame.encloses(tokens[key]) for key in ("agent-0", lorry_key, load_key))
    assert not frame.overlaps(tokens[other])
    assert frame.title == "lorry, h, consignment1"
    assert f"frame-{lorry_key}" not in kept_apart(scene, 0)


def test_what_somebody_holds_is_in_a_frame_with_them(room2: Scene) -> None:
    before, after = kept_apart(room2, 5), kept_apart(room2, 6)
    kit = f"object-{list(room2.frames[0].objects).index('mk2')}"
    assert before["frame-agent-1"].encloses(before[kit])
    assert after["frame-agent-0"].encloses(after[kit])
    assert "frame-agent-1" not in after


def test_several_meetings_in_one_place_have_one_tag(room2: Scene) -> None:
    later = [Meeting(epoch, "hall4", (), "again") for epoch in (9, 11)]
    scene = replace(room2, meetings=(*room2.meetings, *later))
    picture = map_picture(scene, 6)
    assert picture is not None
    (tag,) = ET.fromstring(svg(picture)).findall(f".//{SVG}g[@data-meeting]")
    assert tag.attrib["data-meeting"] == "0 1 2"
    assert "epoch 11: again" in (tag.findtext(f"{SVG}title") or "")


@pytest.mark.parametrize(
    ("domain", "problem", "human"),
    [
        ("driverlog", "pfile3", "driver1"),
        ("zenotravel", "pfile5", "plane1"),
        ("logistics00", "probLOGISTICS-8-0", "tru1"),
        ("rovers", "p10", "rover0"),
        ("satellites", "p05-pfile5", "satellite0"),
        ("elevators08", "p01", "fast0"),
    ],
)
def test_competition_tasks_start_on_a_map_in_order(
    codmap15: Path, domain: str, problem: str, human: str
) -> None:
    folder = codmap15 / domain
    task = serendipity.load_pddl(folder / "domain.pddl", folder / f"{problem}.pddl", human)
    nothing = serendipity.plan(task, mode="individual", time_limit=0.001)
    scene = build_scene(task, replace(nothing, plan=None, human_plan=None))
    assert kept_apart(scene, 0)
    ET.fromstring(str(draw(scene, ".svg")))
