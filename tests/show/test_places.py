"""The map is derived from what agents can do, and from the names of facts."""

from itertools import pairwise

import serendipity
from serendipity.model import Task
from serendipity.pictures.map.places import Whereabouts, find_places
from serendipity.scenarios.usar import figure2
from serendipity.testing import cases
from serendipity.testing.builders import task as build
from serendipity.testing.builders import usar
from tests.show.conftest import ground, spaced, walk


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
