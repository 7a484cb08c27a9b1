"""Pictures are well formed, say what they show, and never carry foreign markup."""

import json
import re
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace

import pytest

import serendipity
from serendipity.model import Task, UsageError
from serendipity.pictures import Scene, build_scene, draw
from serendipity.pictures.picture.drawing import HUMAN, ROBOTS, on, wrapped
from serendipity.pictures.picture.map_picture import tokens
from tests.show.drawn import SVG


def test_a_still_is_well_formed_and_says_what_it_shows(room2: Scene) -> None:
    root = ET.fromstring(str(draw(room2, ".svg")))
    assert root.tag == f"{SVG}svg"
    assert "robot gives mk2 to commx in hall4".casefold() in root.attrib["aria-label"].casefold()
    texts = {element.text for element in root.iter(f"{SVG}text")}
    assert {"room1", "hall4", "mk2", "13", "commx"} <= texts


def test_a_long_timeline_goes_on_in_another_row(room2: Scene) -> None:
    long = replace(
        room2, frames=room2.frames + tuple(replace(room2.frames[-1], epoch=e) for e in range(14, 40))
    )
    short = ET.fromstring(str(draw(room2, ".svg")))
    tall = ET.fromstring(str(draw(long, ".svg")))
    assert float(tall.attrib["height"]) > float(short.attrib["height"])
    assert float(tall.attrib["width"]) < 2000
    assert "39" in {element.text for element in tall.iter(f"{SVG}text")}


def test_every_agent_and_object_has_a_token_in_every_frame(room2: Scene) -> None:
    for frame in room2.frames:
        keys = set(tokens(room2, frame))
        assert {"agent-0", "agent-1", "object-0", "object-1"} <= keys
        assert ("former" in keys) == (frame.former_at != frame.at[room2.human])


@pytest.mark.long
def test_png_is_a_picture(room2: Scene) -> None:
    pytest.importorskip("matplotlib", reason="needs the extra 'plot'")
    content = draw(room2, ".png")
    assert isinstance(content, bytes)
    assert content.startswith(b"\x89PNG")
    width = int.from_bytes(content[16:20], "big")
    root = ET.fromstring(str(draw(room2, ".svg")))
    assert width == round(2 * float(root.attrib["width"]))


def test_png_without_matplotlib_says_what_to_install(room2: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.startswith("matplotlib")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(UsageError, match=r"pip install serendipity-planner\[plot\]"):
        draw(room2, ".png")


def test_the_page_asks_for_nothing_from_any_network(room2: Scene) -> None:
    page = str(draw(room2, ".html"))
    assert set(re.findall(r"https?://[^\"' <)]*", page)) == {"http://www.w3.org/2000/svg"}
    assert not re.search(r"<(link|img|script|iframe)[^>]+(src|href)=\"(?!data:)", page)
    assert "default-src 'none'" in page


def test_the_page_carries_every_frame(room2: Scene) -> None:
    page = str(draw(room2, ".html"))
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found
    data = json.loads(found[1])
    assert [frame["caption"] for frame in data["frames"]] == [frame.caption for frame in room2.frames]
    assert data["frames"][-1]["cost"] == "12.6 of 12.6"
    assert data["frames"][-1]["former"] == "13 of 13"


def test_the_page_of_a_task_without_map_has_no_map(no_map: Scene) -> None:
    page = str(draw(no_map, ".html"))
    assert 'id="map"' not in page
    assert 'id="lanes"' in page


def _hostile() -> Task:
    task = serendipity.example("room2")
    evil = "</script><b>&\"'$x"
    names = tuple(name.replace("room1", f"room1{evil}") for name in task.facts)
    actions = tuple(replace(a, name=a.name.replace("room1", f"room1{evil}")) for a in task.actions)
    return replace(task, name=evil, facts=names, actions=tuple(sorted(actions, key=lambda a: a.key)))


def test_names_never_become_markup() -> None:
    task = _hostile()
    scene = build_scene(task, serendipity.plan(task, discount="0.6"))
    page = str(draw(scene, ".html"))
    assert page.count("</script>") == 2
    assert "<b>" not in page
    ET.fromstring(str(draw(scene, ".svg")))


def _contrast(one: str, other: str) -> float:
    def luminance(colour: str) -> float:
        channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("colour", [HUMAN, *ROBOTS])
def test_letters_can_be_read_on_their_tokens(colour: str) -> None:
    assert _contrast(on(colour), colour) >= 3  # WCAG AA for large and bold text


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("communicate soil data general waypoint6", "communicate soil data general waypoint1"),
        ("communicated_rock_data waypoint4", "communicated_soil_data waypoint4"),
        ("hoist1 crate1 pallet0 depot0", "hoist1 crate1 pallet0 distributor0"),
    ],
)
def test_what_tells_labels_apart_is_not_cut(one: str, other: str) -> None:
    for text in (one, other):
        for bold in (False, True):
            lines, size = wrapped(text, 90, (14, 12, 11, 10, 9), 4, bold=bold)
            assert "".join(lines).replace(" ", "") == text.replace(" ", "")
            assert size >= 9
