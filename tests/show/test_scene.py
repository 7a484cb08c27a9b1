"""Frames tell what happens: states by replay, costs as in the result, meetings where they are.

Who drives is where the vehicle is, and so is what it carries; fuel is no place.
"""

from dataclasses import replace
from fractions import Fraction

import pytest

import serendipity
from serendipity.model import Condition, InputError, PlanStep, Window
from serendipity.pictures import Scene, build_scene
from serendipity.pictures.map.places import Whereabouts, find_places
from serendipity.pictures.picture.map_picture import initials
from serendipity.pictures.scene.scene import headline
from serendipity_testing import cases
from serendipity_testing.builders import task
from serendipity_testing.cases import WORKED, Worked
from tests.show.conftest import WARDS, ground


@pytest.mark.parametrize("worked", WORKED, ids=str)
def test_the_costs_run_up_to_those_of_the_result(worked: Worked) -> None:
    task = worked.task()
    result = serendipity.plan(task, human_plan=worked.human_plan, **worked.options)
    scene = build_scene(task, result)
    last = scene.frames[-1]
    if result.plan is not None:
        assert last.cost == Fraction(str(result.cost))
        for agent, cost in result.agent_costs.items():
            assert last.spent[task.agents.index(agent)] == Fraction(str(cost))
    if result.human_cost is not None:
        assert last.former_spent == Fraction(str(result.human_cost))
    costs = [frame.cost for frame in scene.frames]
    assert costs == sorted(costs)
    assert [frame.epoch for frame in scene.frames] == list(range(len(scene.frames)))
    shaded = [frame.epoch for frame in scene.frames if frame.in_window]
    window = result.window or Window(1, 2)
    assert shaded == (list(range(window.start, window.end)) if result.window else [])


def test_agents_and_objects_move(room2: Scene) -> None:
    human, robot = 0, 1
    start, met, end = room2.frames[0], room2.frames[6], room2.frames[11]
    assert start.at == {human: "room13", robot: "room4"}
    assert start.objects == {"mk1": Whereabouts("room2"), "mk2": Whereabouts("room3")}
    assert room2.frames[5].objects["mk2"] == Whereabouts(holder=robot)
    assert met.at == {human: "hall4", robot: "hall4"}
    assert met.objects["mk2"] == Whereabouts(holder=human)
    assert (met.former_at, met.cost, met.former_spent) == ("hall3", Fraction("7.6"), 6)
    assert end.at[human] == "room1"
    assert "conducted_triage commx room1" in end.made
    assert room2.goals == ("room1",)
    assert len(room2.frames) == 14  # to the end of the former plan


def test_the_hand_over_is_a_meeting(room2: Scene) -> None:
    (meeting,) = room2.meetings
    assert (meeting.epoch, meeting.place, meeting.objects) == (6, "hall4", ("mk2",))
    assert meeting.text == "robot gives mk2 to commx in hall4"
    assert room2.key_epoch == 6


def test_ground_files_give_the_same_frames(room2: Scene) -> None:
    task = ground(serendipity.example("room2"))
    scene = build_scene(task, serendipity.plan(task, discount="0.6"))
    assert [frame.at for frame in scene.frames] == [frame.at for frame in room2.frames]
    assert [frame.objects for frame in scene.frames] == [frame.objects for frame in room2.frames]
    assert [frame.caption for frame in scene.frames] == [frame.caption for frame in room2.frames]
    assert [meeting.text for meeting in scene.meetings] == [meeting.text for meeting in room2.meetings]


def test_without_a_map_there_are_the_facts(no_map: Scene) -> None:
    assert no_map.layout is None
    assert [(change.label, change.goal) for change in no_map.changes] == [("p", True), ("q", False)]
    goal, lifted = no_map.changes
    assert [(span.first, span.last) for span in goal.spans] == [(2, 2)]
    assert [(span.first, span.last) for span in lifted.spans] == [(1, 2)]
    assert no_map.meetings[0].text == "r1 and r2: lift"


def test_where_no_help_pays_the_human_does_not_deviate() -> None:
    task = cases.case_1()
    scene = build_scene(task, serendipity.plan(task, discount="0.5"))
    assert not scene.deviates
    assert scene.meetings == ()
    assert all(frame.former_at == frame.at[task.human] for frame in scene.frames)


def test_a_plan_that_does_not_fit_the_task_is_refused() -> None:
    task = serendipity.example("room2")
    result = serendipity.plan(task, discount="0.6")
    wrong = replace(result, plan=(PlanStep(1, ("robot",), "move robot room4 hall9", 1.0),))
    with pytest.raises(InputError, match="hall9"):
        build_scene(task, wrong)
    late = replace(result, plan=(PlanStep(1, ("robot",), "pick_up_medkit robot mk2 room3", 1.0),))
    with pytest.raises(InputError, match="not applicable"):
        build_scene(task, late)
    stranger = replace(result, plan=(PlanStep(1, ("commx",), "move robot room4 hall4", 1.0),))
    with pytest.raises(InputError, match="commx"):
        build_scene(task, stranger)


def test_goals_are_lanes_that_end_when_they_are_destroyed() -> None:
    actions = {"do h": "-> p !q", "undo h": "p -> !p", "rest r": "-> q"}
    built = task(init="q", goal="p !q", actions=actions)
    result = serendipity.plan(built, mode="individual")
    steps = [
        PlanStep(i, (who,), f"{verb} {who}", 1.0)
        for i, (verb, who) in enumerate([("do", "h"), ("undo", "h"), ("rest", "r"), ("do", "h")], 1)
    ]
    scene = build_scene(built, replace(result, plan=tuple(steps)))
    spans = {change.label: [(span.first, span.last) for span in change.spans] for change in scene.changes}
    assert spans == {"p": [(1, 1), (4, 4)], "not q": [(1, 2), (4, 4)]}
    assert all(change.goal for change in scene.changes)


def test_where_the_human_has_to_be_is_a_goal_on_the_map_and_in_the_lanes() -> None:
    built = replace(cases.case_2(), goal=Condition((cases.case_2().facts.index("at h u"),)))
    scene = build_scene(built, serendipity.plan(built, discount="0.5"))
    assert scene.goals == ("u",)
    (goal,) = [change for change in scene.changes if change.goal]
    assert goal.label == "at h u"
    assert [(span.first, span.last) for span in goal.spans] == [(4, 4)]


def test_assistance_goes_turn_by_turn() -> None:
    built = cases.case_6()  # close x, then carry: the second needs what the first did
    result = serendipity.plan(built, mode="assistance", ties="optimistic")
    scene = build_scene(built, result)
    assert scene.frames[-1].spent == {0: 0, 1: 2}
    assert headline(scene).startswith("assistance, ties optimistic: ")


DORA, ROLO = 0, 1


def test_places_are_also_where_only_vehicles_go() -> None:
    places = find_places(serendipity.example("parcels"))
    assert places.names == ("depot", "home", "inn", "lane", "market", "mill")
    assert ("depot", "home") in places.links and ("inn", "market") in places.links


def epoch_of(scene: Scene, agent: int, verb: str, detail: str) -> int:
    return next(
        act.epoch for act in scene.acts if (act.agents, act.verb, act.detail) == ((agent,), verb, detail)
    )


def test_a_driver_is_on_the_map_all_the_time(parcels: Scene) -> None:
    assert [frame.at[DORA] for frame in parcels.frames[:6]] == ["home", *["depot"] * 3, "inn", "inn"]
    rolo = [frame.at[ROLO] for frame in parcels.frames]
    for epoch, place in enumerate(rolo[1:], start=1):
        assert place == rolo[epoch - 1] or epoch == epoch_of(parcels, ROLO, "go to", place)
    assert (rolo[0], rolo[-1]) == ("mill", "inn")


def test_what_is_loaded_is_with_the_driver(parcels: Scene) -> None:
    flour = [frame.objects["flour"] for frame in parcels.frames]
    loaded, delivered = (epoch_of(parcels, ROLO, verb, "flour") for verb in ("load", "deliver"))
    taken = epoch_of(parcels, DORA, "load", "flour")
    assert flour[:taken] == [
        *[Whereabouts("mill")] * loaded,
        *[Whereabouts(holder=ROLO, carrier="cart")] * (delivered - loaded),
        *[Whereabouts("inn")] * (taken - delivered),
    ]
    assert flour[taken] == Whereabouts(holder=DORA, carrier="van")
    assert flour[-1] == Whereabouts("market")


def test_a_vehicle_is_drawn_with_and_without_a_driver(parcels: Scene) -> None:
    van = [frame.objects["van"] for frame in parcels.frames]
    assert van[:3] == [Whereabouts("depot"), Whereabouts("depot"), Whereabouts("depot", riders=(DORA,))]


def test_driving_is_going_somewhere_and_loading_names_the_load(parcels: Scene) -> None:
    dora = {act.epoch: (act.verb, act.detail) for act in parcels.acts if act.agents == (DORA,)}
    assert dora[2] == ("enter", "van")
    assert dora[3] == ("load", "box")
    assert dora[4] == ("go to", "inn")
    assert dora[5] == ("deliver", "box")


def test_what_one_vehicle_brings_and_another_takes_changes_hands(parcels: Scene) -> None:
    (meeting,) = parcels.meetings
    assert meeting.epoch == epoch_of(parcels, DORA, "load", "flour")
    assert (meeting.place, meeting.objects) == ("inn", ("flour",))
    assert meeting.text == "dora takes flour, which rolo left"


def test_levels_of_fuel_are_no_places() -> None:
    places = find_places(serendipity.example("flights"))
    assert places.names == ("capital", "harbour", "island", "ridge")
    assert sorted(places.objects) == ["ann", "bob"]


def test_three_taxis_have_three_positions() -> None:
    places = find_places(serendipity.example("taxis"))
    assert sorted(places.positions) == [0, 1, 2]
    assert sorted(places.objects) == ["ann", "ben"]


@pytest.fixture(scope="module")
def night_shift() -> Scene:
    """A newcomer's domain (ADL: a nurse, two carts, ten wards): lanes and letters are what people write."""
    task = serendipity.load_pddl(WARDS / "domain.pddl", WARDS / "problem.pddl", "eva", ["carta", "cartb"])
    return build_scene(task, serendipity.plan(task, mode="individual"))


def test_a_thing_has_a_lane_of_its_own_name(night_shift: Scene) -> None:
    lane = next(change for change in night_shift.changes if change.label == "aspirin")
    assert [span.value for span in lane.spans] == ["stocked aspirin", "carries eva aspirin", "given aspirin"]


def test_goals_that_always_hold_have_no_lane(night_shift: Scene) -> None:
    goals = [change.label for change in night_shift.changes if change.goal]
    assert goals == ["fresh w6", "treated mila", "not wet w6"]


def test_sheets_are_on_the_map(night_shift: Scene) -> None:
    assert set(night_shift.frames[0].objects) == {"sheet1", "sheet2"}
    assert len(night_shift.layout.boxes) == 11


@pytest.mark.parametrize(
    ("agents", "letters"),
    [
        ("eva carta cartb", "E C1 C2"),
        ("commx robot", "C R"),
        ("commx robot1 robot2", "C R1 R2"),
        ("c2 carta cartb", "C2 C1 C3"),
        ("robot11 rover11 rob", "R1 R2 R"),
    ],
)
def test_letters_are_numbered_from_one(agents: str, letters: str) -> None:
    assert initials(tuple(agents.split())) == tuple(letters.split())
