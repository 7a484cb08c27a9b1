"""Labels of things in one place lie apart and within it; what is in or on something is drawn with it."""

import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import combinations, permutations
from pathlib import Path

import pytest

import serendipity
from serendipity.model import Task
from serendipity.pictures import Scene, build_scene, draw
from serendipity.pictures.formats.svg import svg
from serendipity.pictures.picture.map_picture import MARGIN, map_picture
from serendipity.pictures.scene.scene import Meeting
from serendipity.testing.builders import task as build
from tests.show.conftest import spaced, walk
from tests.show.drawn import SVG, Drawn, drawn_tokens

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
