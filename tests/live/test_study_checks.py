"""Whether participants have understood, and attend: asked, recorded, and told in the table."""

import csv
import io
from pathlib import Path

import pytest

from serendipity.live.study import analysis
from serendipity.live.study.design import open_design
from serendipity.model import InputError
from tests.live.studies import PLAIN, answer, finish, join, opened, say

CHECKED = PLAIN.replace(
    'conditions = ["none", "silent"]',
    """conditions = ["none", "silent"]
tries = 2
[[comprehension]]
text = "What ends a round?"
kind = "choice"
choices = ["the goal", "the clock"]
expect = "the goal"
[[questions]]
text = "Choose 2 here."
expect = 2""",
)


@pytest.fixture
def checked(tmp_path: Path) -> Path:
    (tmp_path / "study.toml").write_text(CHECKED)
    return tmp_path


def table(folder: Path) -> list[dict[str, str]]:
    design = open_design(folder)
    text = opened(folder).file(f"experimenter/{design.secret}/rounds.csv").text
    return list(csv.DictReader(io.StringIO(text)))


def test_who_has_not_understood_reads_again(checked: Path) -> None:
    room = join(opened(checked))
    assert say(room, "go on")["stage"] == "comprehension"
    (question,) = room.view()["study"]["questions"]
    assert "expect" not in question
    answer(room, What="the clock")
    view = room.view()
    assert (view["stage"], view["study"]["again"]) == ("instructions", True)
    moment = view["moment"]
    room = opened(checked).room(room.joined["token"])  # the server was stopped in between
    assert room.view()["moment"] == moment
    say(room, "go on")
    answer(room, What="the goal")
    assert room.view()["stage"] == "play"
    finish(room, open_design(checked), Choose=2)
    assert {(row["understood"], row["attentive"]) for row in table(checked)} == {("2", "true")}


def test_who_never_does_plays_all_the_same_and_is_told_apart(checked: Path) -> None:
    room = join(opened(checked))
    for _ in range(2):
        say(room, "go on")
        answer(room, What="the clock")
    assert room.view()["stage"] == "play"
    finish(room, open_design(checked), Choose=3)
    assert {(row["understood"], row["attentive"]) for row in table(checked)} == {("never", "false")}


def test_the_analysis_can_leave_them_out(checked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for attends in (True, False):
        room = join(opened(checked))
        say(room, "go on")
        answer(room, What="the goal")
        finish(room, open_design(checked), Choose=2 if attends else 3)
    design = open_design(checked)
    file, plot = checked / "rounds.csv", checked / "means.svg"
    file.write_text(opened(checked).file(f"experimenter/{design.secret}/rounds.csv").text)
    assert len({row["participant"] for row in analysis.read_rounds(file)}) == 2
    assert analysis.main([str(file), "--attentive", "--plot", str(plot)]) == 0
    assert capsys.readouterr().out.startswith("1 finished participants")
    assert "<svg" in plot.read_text()


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("[[comprehension]]\ntext = 'Why?'", "each question says what to expect"),
        ("[[questions]]\ntext = 'Why?'\nexpect = 9", "expect: expected a whole number from 1 to 7"),
        ("tries = 0", "tries"),
    ],
)
def test_checks_that_can_not_be_are_refused(tmp_path: Path, text: str, fault: str) -> None:
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(InputError, match=fault):
        open_design(tmp_path)
