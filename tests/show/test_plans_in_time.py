"""Plans in time are drawn as they happen: bars with lengths, a clock, bystanders, and the script."""

import xml.etree.ElementTree as ET

import pytest
from hypothesis import assume, given

import serendipity
from serendipity.model import GroundAction, Script
from serendipity.pictures import build_scene, draw
from serendipity.pictures.picture.timeline_picture import column
from serendipity.testing.builders import task
from serendipity.testing.call import Call
from serendipity.testing.oracle.epochs import after, parts_of
from serendipity.testing.strategies import calls_in_time
from tests.facade.test_results_tell_times import answered
from tests.show.drawn import SVG


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
