"""The map is derived from what agents can do, and from the names of facts."""

from itertools import pairwise

import serendipity
from serendipity.model import Task
from serendipity.pictures.map.places import Whereabouts, find_places
from serendipity.scenarios.building import figure2
from serendipity.testing import cases
from serendipity.testing.builders import _atom_task, usar
from tests.show.conftest import ground


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


def test_ground_files_give_the_same_map() -> None:
    task = serendipity.example("room2")
    assert find_places(ground(task)) == find_places(task)


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
    actions: dict[str, tuple[tuple[str, ...], str, str]] = {}
    for a, b in [*pairwise(cells), *pairwise(cells[::-1])]:
        effects = f"at h {b}, free {a}, !at h {a}, !free {b}"
        actions[f"walk h {a} {b}"] = (("h",), f"at h {a}, free {b}", effects)
    for a, b, c in zip(cells, cells[1:], cells[2:], strict=False):
        effects = f"at h {b}, at crate {c}, free {a}, !at h {a}, !at crate {b}, !free {c}"
        actions[f"push h {a} {b} {c}"] = (("h",), f"at h {a}, at crate {b}, free {c}", effects)
    return _atom_task(("h", "r"), ["at h c1", "at crate c2", "free c3", "free c4"], "at crate c4", actions)


def test_a_crate_that_is_pushed_is_no_agent() -> None:
    task = _pushing()
    places = find_places(task)
    assert list(places.positions) == [0]
    assert {task.facts[f] for f in places.positions[0]} == {f"at h c{i}" for i in range(1, 5)}
    assert list(places.objects) == ["crate"]


def test_who_rides_is_where_the_vehicle_is() -> None:
    actions: dict[str, tuple[tuple[str, ...], str, str]] = {}
    for a, b in (("p", "q"), ("q", "p")):
        actions[f"walk h {a} {b}"] = (("h",), f"at h {a}", f"at h {b}, !at h {a}")
        actions[f"drive h {a} {b}"] = (("h",), f"in h car, at car {a}", f"at car {b}, !at car {a}")
        actions[f"enter h {a}"] = (("h",), f"at h {a}, at car {a}", f"in h car, !at h {a}")
        actions[f"leave h {a}"] = (("h",), f"in h car, at car {a}", f"at h {a}, !in h car")
    task = _atom_task(("h", "r"), ["at h p", "at car p"], "at h q", actions)
    places = find_places(task)
    assert {task.facts[f]: name for f, name in places.riding[0].items()} == {"in h car": "car"}


def test_the_place_may_stand_before_the_agent() -> None:
    actions: dict[str, tuple[tuple[str, ...], str, str]] = {}
    for who in ("h", "r"):
        for a, b in (("p", "q"), ("q", "p")):
            actions[f"walk {who} {a} {b}"] = (
                (who,),
                f"holds {a} {who}",
                f"holds {b} {who}, !holds {a} {who}",
            )
    places = find_places(_atom_task(("h", "r"), ["holds p h", "holds q r"], "holds q h", actions))
    assert places.names == ("p", "q")
    assert sorted(places.positions) == [0, 1]
