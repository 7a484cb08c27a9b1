"""Figures in physics walk, carry and hand over; what is in their way makes them late, or fail."""

import io
import sys
from pathlib import Path

import pytest
from PIL import Image

import serendipity
from serendipity.model import Task, UsageError
from serendipity.robot import Epoch, physics
from serendipity_testing.builders import task as build
from tests.cli.conftest import Runs
from tests.robot.contract import LIFT, WALK, keeps_its_contract, told


@pytest.fixture(name="needs_bullet", scope="module")
def _needs_bullet() -> None:
    pytest.importorskip("pybullet", reason="needs the extra 'robot'")


@pytest.mark.usefixtures("needs_bullet")
class TestFigures:
    def test_contract(self, room2: Task) -> None:
        run = keeps_its_contract(room2, physics.Stage(room2))
        assert (float(run.cost), run.human_cost) == (12.6, 11)
        walked = [each.report.seconds for passed in run.passed for each in passed.reports]
        assert all(1 < seconds < 5 for seconds in walked)

    def test_a_walk_that_is_longer_than_an_epoch_goes_on(self, room2: Task) -> None:
        stage = physics.Stage(room2, epoch=2)
        reports = [told(room2, stage, epoch, WALK)[0] for epoch in (1, 2)]
        stage.close()
        assert [report.outcome for report in reports] == ["running", "done"]
        assert reports[0].seconds == 2 < reports[1].seconds < 4

    def test_rubble_makes_it_late_and_more_of_it_makes_it_fail(self, room2: Task) -> None:
        seconds = []
        for kilograms in (0.01, 11.0, 500.0):
            stage = physics.Stage(room2, epoch=10, rubble={("room4", "room3"): kilograms})
            (report,) = told(room2, stage, 1, WALK)
            stage.close()
            seconds.append(report.seconds)
        assert report.outcome == "failed" and report.note == "stuck on the way to room3"
        assert seconds[0] + 1 < seconds[1], "it has to be pushed aside"

    def test_a_walk_that_was_given_up_is_taken_up_from_there(self, room2: Task) -> None:
        stage = physics.Stage(room2, epoch=2)
        assert told(room2, stage, 1, WALK)[0].outcome == "running"
        assert told(room2, stage, 2) == []
        (report,) = told(room2, stage, 3, WALK)
        stage.close()
        assert report.outcome == "done" and report.seconds < 2.5

    def test_what_is_elsewhere_is_where_the_world_has_it(self, room2: Task) -> None:
        names = {name: fact for fact, name in enumerate(room2.facts)}
        state = room2.init - {names["at robot room4"], names["at mk2 room3"]}
        state |= {names["at robot room3"], names["at mk2 room2"]}
        stage = physics.Stage(room2.at(state))
        seen = stage.execute(
            Epoch(1, state - {names["at mk2 room2"]} | {names["at mk2 room3"]}, None, (LIFT,))
        )
        stage.close()
        assert [report.outcome for report in seen] == ["done"], "somebody has brought it back"

    def test_the_same_again(self, room2: Task) -> None:
        def seconds() -> list[float]:
            stage = physics.Stage(room2)
            found = [each.seconds for each in told(room2, stage, 1, WALK)]
            stage.close()
            return found

        assert seconds() == seconds()

    def test_a_task_needs_a_map(self) -> None:
        with pytest.raises(UsageError, match="pybullet is for tasks with a map"):
            physics.Stage(build(goal="p", actions={"do h": "-> p", "help r": "-> p"}))

    def test_rubble_lies_in_doorways(self, room2: Task) -> None:
        with pytest.raises(UsageError, match="rubble: there is no doorway between room1 and room2"):
            physics.Stage(room2, rubble={("room1", "room2"): 1.0})

    def test_a_run_is_filmed(self, run: Runs) -> None:
        Path("record").write_text("noop\n")
        words = "--human recorded:record --epochs 1 --adapter pybullet --epoch-seconds 0.3 --clip walk.gif"
        assert run(f"execute --example room2 {words}").code == 1  # nobody arrives in one epoch
        with Image.open("walk.gif") as film:
            assert film.n_frames == 2 and film.width == 960

    @pytest.mark.parametrize(("name", "kits"), [("room2", True), ("parcels", False)])
    def test_medkits_alone_are_red(self, name: str, kits: bool) -> None:
        task, film = serendipity.example(name), physics.Film(width=640, rate=2)
        runs = serendipity.execute(
            task, epochs=1, adapter=lambda *_: physics.Stage(task, epoch=0.5, film=film)
        )
        with Image.open(io.BytesIO(film.clip(".png", runs.logs[0]))) as clip:
            seen = {colour for _, colour in clip.convert("RGB").getcolors(maxcolors=1 << 24) or ()}
        assert any(r > 200 and max(g, b) < r / 4 for r, g, b in seen) is kits

    @pytest.mark.parametrize("suffix", physics.FORMATS)
    def test_films_have_a_format(self, room2: Task, suffix: str) -> None:
        film = physics.Film(width=160, rate=2)
        runs = serendipity.execute(
            room2, epochs=2, adapter=lambda task, _: physics.Stage(task, epoch=1, film=film)
        )
        with Image.open(io.BytesIO(film.clip(suffix, runs.logs[0]))) as clip:
            assert clip.n_frames > 1 and clip.width == 160


def test_without_bullet_one_line_says_what_to_install(room2: Task, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pybullet", None)
    with pytest.raises(UsageError, match=r"need pybullet: pip install serendipity-planner\[robot\]"):
        physics.Stage(room2)
