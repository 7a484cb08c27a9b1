"""An answer over scenarios is drawn as the tree of its histories, above what happens in one of them.

Plans in time are drawn as they happen: bars with lengths, a clock, bystanders, and the script.
"""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import pytest
from hypothesis import assume, given

import serendipity
from serendipity.model import GroundAction, Result, Script, UsageError
from serendipity.pictures import Scene, build_scene, draw
from serendipity.pictures.map.names import ems
from serendipity.pictures.picture.drawing import Polyline, Rect, Shape, ShapeGroup, Text
from serendipity.pictures.picture.timeline_picture import column, lane_labels, timeline_picture
from serendipity.pictures.picture.tree_picture import tree, tree_height
from serendipity.pictures.scene.scene import headline, scenario_lines
from serendipity_testing.builders import task
from serendipity_testing.call import Call
from serendipity_testing.oracle.epochs import after, parts_of
from serendipity_testing.strategies import calls_in_time
from tests.facade.test_results_tell_times import answered
from tests.show.drawn import SVG

ROOMS = ("room1", "room3", "room9", "room6", "room12")
LONG = "the one who looks after all of the patients in "


def policy(rooms: int = 3, name: str = "", **options: str) -> Result:
    """The answer for a person who may want triage in one of the first rooms."""
    goals = [{"name": name + room, "goal": [f"conducted_triage commx {room}"]} for room in ROOMS[:rooms]]
    return serendipity.plan(serendipity.example("room2"), discount="0.9", goals=goals, **options)


@pytest.fixture(scope="module")
def watching() -> Result:
    return policy()


def words(scene: Scene) -> set[str]:
    return {text.text for text in texts(timeline_picture(scene).shapes)}


def scene_of(result: Result, scenario: str | None = None) -> Scene:
    return build_scene(serendipity.example("room2"), result, scenario)


def texts(shapes: tuple[Shape, ...], x: float = 0, y: float = 0) -> Iterator[Text]:
    """The words of a picture, where they stand on its sheet."""
    for shape in shapes:
        if isinstance(shape, ShapeGroup):
            yield from texts(shape.shapes, x + shape.x, y + shape.y)
        elif isinstance(shape, Text) and shape.text:
            yield replace(shape, x=x + shape.x, y=y + shape.y)


def test_a_bar_for_each_history_says_what_may_be_and_by_what_that_is_known(watching: Result) -> None:
    scene = scene_of(watching)
    found = [(h.start, h.end, h.scenarios) for h in scene.histories]
    assert found == [(1, 2, (0, 1, 2)), (2, 11, (0, 2)), (11, 14, (0,)), (11, 14, (2,)), (2, 14, (1,))]
    assert {"1, 2, 3 · 1", "1, 3 · 0.6667", "seen: go to hall8", "seen: wait"} <= words(scene)
    rows = tree(scene, 0, 0, 13, 10)
    bars = [(s.x - 1, s.x + s.width + 1) for s in rows if isinstance(s, Rect) and s.style.stroke]
    assert bars == [(10 * h.start, 10 * h.end) for h in scene.histories]
    assert headline(scene) == "expected cost 10.6, 1.067 less than 11.67 (proved)"
    blind = scene_of(policy(policy="fixed"))
    assert [h.scenarios for h in blind.histories] == [(0, 1, 2)]


def test_one_scenario_is_played_below(watching: Result) -> None:
    for chosen, room, last in ((None, "room1", 13), ("room3", "room3", 11), ("3", "room9", 13)):
        scene = scene_of(watching, chosen)
        assert scene.goals == (room,)
        assert scene.frames[-1].at[scene.human] == room
        assert scene.frames[-1].epoch == last  # of the former plan, or the other scenarios
        assert [chosen for _, chosen in scenario_lines(scene)] == [name == room for name in ROOMS[:3]]
    goals = watching.goals or ()
    likely = replace(watching, goals=(goals[0], replace(goals[1], probability=0.5), goals[2]))
    assert scene_of(likely).scenario == 1


def test_a_joint_action_of_some_scenarios_names_them(watching: Result) -> None:
    goals = watching.goals or ()
    plans = [tuple(s for s in goals[0].plan or () if s.epoch <= last) for last in (6, 5)]
    some = tuple(replace(g, plan=plan) for g, plan in zip(goals[::2], plans, strict=True))
    assert {"1: hand", "over"} <= words(scene_of(replace(watching, goals=some)))
    assert "1: hand" not in words(scene_of(watching))


@pytest.mark.parametrize("rooms", [2, 3, 4, 5])
def test_words_do_not_overlap(rooms: int) -> None:
    require_apart(scene_of(policy(rooms, LONG)), (0, None), (0, 5), (6, 6), (7, 10), (11, 12))


@pytest.mark.parametrize("column", [98, 40, 24])
@pytest.mark.parametrize("rooms", [3, 5])
def test_no_line_runs_through_words(rooms: int, column: int) -> None:
    """The words of a bar near the right edge stood on the line that leads to it."""
    shapes = list(tree(scene_of(policy(rooms)), 0, 0, 13, column))
    lines = [shape.points for shape in shapes if isinstance(shape, Polyline)]
    for text in texts(tuple(shapes)):
        for _, (x, top), (_, bottom), _ in lines:
            left, right = _sides(text)
            assert not (left < x < right and top < text.y < bottom), text.text


def test_the_frame_of_the_shown_epoch_stands_behind_words(watching: Result, room2: Scene) -> None:
    for scene in (scene_of(watching), room2):
        shapes = timeline_picture(scene, now=2).shapes
        frame = next(i for i, s in enumerate(shapes) if isinstance(s, ShapeGroup) and "cursor" in s.data)
        behind = [s for s in shapes[:frame] if not (isinstance(s, ShapeGroup) and "column" in s.data)]
        assert not [*texts(tuple(behind))]


def test_bars_in_time_stand_below_the_clock_and_are_as_long_as_actions() -> None:
    task = serendipity.example("morning")
    alone = serendipity.plan(task, mode="individual")
    plan = alone.human_plan_times.entries(alone.human_plan)
    later = [(epoch + 4, action) for epoch, action in plan]
    library = [{"probability": 1, "plan": one} for one in (plan, later)]
    answer = serendipity.plan(task, plans=library, discount="0.9")
    scene = build_scene(task, answer)
    require_apart(scene, (0, None), (0, 10), (11, 20))
    acts = [shape for shape in tree(scene, 0, 0, 25, 10) if isinstance(shape, ShapeGroup)]
    bars = [next(s.width for s in act.shapes if isinstance(s, Rect)) for act in acts]
    durations = [step.duration for history in scene.histories for step in history.robots]
    assert len({bar // 10 for bar in bars}) == len(set(durations)) > 1


def require_apart(scene: Scene, *parts: tuple[int, int | None]) -> None:
    """Fail where words of the upper part overlap, or leave their picture."""
    head = 34 + tree_height(scene) + (0 if scene.unit is None else 16)
    for picture in (lane_labels(scene), *(timeline_picture(scene, *part) for part in parts)):
        found = [text for text in texts(picture.shapes) if text.y < head]
        assert len(found) > 1
        for one, other in combinations(found, 2):
            across = min(_sides(one)[1], _sides(other)[1]) - max(_sides(one)[0], _sides(other)[0])
            assert across < 1 or abs(one.y - other.y) > 0.4 * (one.size + other.size)
        assert all(-1 <= side <= picture.width + 1 for text in found for side in _sides(text))


def _sides(text: Text) -> tuple[float, float]:
    wide = ems(text.text) * text.size
    left = {"start": text.x, "middle": text.x - wide / 2, "end": text.x - wide}[text.anchor]
    return left, left + wide


def test_the_page_names_the_scenarios_and_keeps_names_from_being_markup() -> None:
    page = str(draw(scene_of(policy(2, "</script><b>")), ".html"))
    assert "<p class=played>1 &lt;/script&gt;&lt;b&gt;room1: probability 0.5, " in page
    assert "<b>" not in page


def test_only_a_page_of_several_scenarios_has_a_choice(watching: Result, room2: Scene) -> None:
    page = serendipity.show(serendipity.example("room2"), watching, scenario="room3").html()
    assert re.findall(r'<template data-scenario="(\d)">', page) == ["0", "2"]
    assert '<option value="1" selected>2 room3</option>' in page
    assert "<select" not in str(draw(room2, ".html"))


def test_scenarios_that_are_not_there_are_named(watching: Result, room2: Scene) -> None:
    with pytest.raises(UsageError, match="expected one of room1, room3, room9; got 'attic'"):
        serendipity.show(serendipity.example("room2"), watching, scenario="attic")
    with pytest.raises(UsageError, match="about no scenarios; got 'room1'"):
        scene_of(room2.result, "room1")


@pytest.mark.long
@given(calls_in_time())
def test_bars_states_and_costs_are_those_of_the_answer(call: Call) -> None:
    built, answer = call.task, answered(call)
    assume(answer.plan is not None)
    scene = build_scene(built, answer)
    last = scene.frames[-1]
    others = [step for listed in answer.bystanders.values() for step in listed if step.epoch <= last.epoch]
    drawn = {(act.epoch, act.end, *(built.agents[i] for i in act.agents)) for act in scene.acts}
    assert drawn == {(step.epoch, step.end, *step.agents) for step in (*answer.plan, *others)}
    assert float(last.cost) == answer.cost
    assert answer.human_cost is None or float(last.former_spent) == answer.human_cost
    begun = [(step.epoch, [built.actions[i] for i in built.named[step.action]]) for step in answer.plan]
    begun += [(deed.epoch, list(deed.variants)) for deed in built.script.deeds]
    shown = state = built.init
    parts: dict[int, list[GroundAction]] = {}
    for frame in scene.frames[1:]:
        for variants in (several for start, several in begun if start == frame.epoch):
            action = next(one for one in variants if one.applicable(state))
            for epoch, part in enumerate(parts_of(action), start=frame.epoch):
                parts.setdefault(epoch, []).append(part)
        true, false = built.script.changes(frame.epoch)
        state = (after(state, parts.get(frame.epoch, ())) - false) | true
        shown = shown.difference(map(built.facts.index, frame.undone)) | {*map(built.facts.index, frame.made)}
        assert shown == state


def test_an_office_with_a_meeting_and_a_lift() -> None:
    office = serendipity.example("office")
    scene = build_scene(office, serendipity.plan(office, discount="0.5"))
    carls = [frame.at[scene.lanes[-1]] for frame in scene.frames[:4]]
    assert carls == ["post", "lobby", "lobby", "landing"]
    assert any("rolf: set-chairs hall (2 of 4)" in frame.caption for frame in scene.frames)
    root, page = ET.fromstring(str(draw(scene, ".svg", 10))), str(draw(scene, ".html"))
    bars = {group.findtext(f"{SVG}title"): group.find(f"{SVG}rect") for group in root.iter(f"{SVG}g")}
    for act in scene.acts:
        width = act.duration * column(scene) - 8
        assert float(bars[act.action].attrib["width"]) == pytest.approx(width, abs=0.01)
    texts = {element.text for element in root.iter(f"{SVG}text")}
    assert {"carl (bystander)", "what happens", "free meeting-room", "26", "13 *"} <= texts
    assert "<td>set-chairs rolf hall [4]</td>" in page and '"clock":"24–26"' in page


def test_a_day_of_many_epochs_is_narrow() -> None:
    late = task(goal="done", actions={"do h": "open -> done [20]"}).with_script(Script(facts=[(100, "open")]))
    scene = build_scene(late, serendipity.plan(late))
    assert (column(scene), len(scene.frames)) == (24, 121)


def test_a_joint_action_is_met_where_it_ends() -> None:
    built = task(goal="up", actions={"lift h r": "-> up [3]", "climb h": "-> up @ 9"})
    scene = build_scene(built, serendipity.plan(built, mode="composite", horizon=3))
    assert [meeting.epoch for meeting in scene.meetings] == [3]
