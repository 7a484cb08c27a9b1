"""A newcomer's domain (ADL: a nurse, two carts, ten wards): lanes and letters are what people would write."""

from pathlib import Path

import pytest

import serendipity
from serendipity.pictures import Scene, build_scene
from serendipity.pictures.picture.map_picture import initials

DATA = Path(__file__).parent / "data" / "wards"


@pytest.fixture(scope="module")
def night_shift() -> Scene:
    task = serendipity.load_pddl(DATA / "domain.pddl", DATA / "problem.pddl", "eva", ["carta", "cartb"])
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
