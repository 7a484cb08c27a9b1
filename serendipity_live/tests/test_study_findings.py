"""What comes out of a study, and for whom; whether participants have understood, and attend."""

import csv
import io
from collections import Counter
from itertools import islice
from pathlib import Path

import pytest

from serendipity_live.play.records import Event
from serendipity_live.play.round import CONDITIONS
from serendipity_live.study import analysis
from serendipity_live.study.design import open_design
from serendipity_live.study.drawing import places
from serendipity_live.study.participant import Participant
from serendipity_live.tests.studies import PLAIN, answer, finish, join, opened, say


def test_only_who_has_the_secret_sees_and_saves(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    join(study).joined["outside_id"] = "<b>x</b>"  # as a record that was written by others may have it
    start = f"experimenter/{design.secret}/"
    for name in ("", "events.json", "events.csv", "rounds.csv", "codebook.csv"):
        assert study.file(start + name) is not None
        assert study.file(f"experimenter/{'x' * len(design.secret)}/{name}") is None
    assert study.file(start + "study.json") is None
    assert study.file("export.json") is None
    page = study.file(start)
    assert "&lt;b&gt;x" in page.text
    assert not any(f">{name}<" in page.text for name in CONDITIONS)


def test_what_is_saved_while_somebody_joins_is_whole(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study, told = opened(folder), Participant.events
    names = [join(study).name, join(study).name]

    def meanwhile(participant: Participant) -> list[Event]:
        join(study)
        return told(participant)

    monkeypatch.setattr(Participant, "events", meanwhile)
    assert list(dict.fromkeys(event["participant"] for event in study.events())) == names


@pytest.mark.long
def test_the_table_of_rounds_is_read_back(folder: Path, capsys) -> None:
    study, design = opened(folder, seed=1), open_design(folder)
    for _ in range(4):
        finish(join(study), design)
    say(join(study), "go on")
    say(join(study), "withdraw")
    start = f"experimenter/{design.secret}/"
    table, book = study.file(start + "rounds.csv"), study.file(start + "codebook.csv")
    head = table.text.splitlines()[0].split(",")
    assert [line.split(",")[0] for line in book.text.splitlines()[1:]] == head
    (folder / "rounds.csv").write_text(table.text)
    rows = analysis.read_rounds(folder / "rounds.csv")
    assert Counter(row["condition"] for row in rows) == {"none": 4, "silent": 4}
    drawn = list(islice(places(["none", "silent"], 2, seed=int(rows[0]["seed"])), 4))
    assert [drawn[int(row["place"])][0] for row in rows] == [row["condition"] for row in rows]
    assert sorted({row["place"] for row in rows}) == ["0", "1", "2", "3"]
    assert {row["answer_1"] for row in rows} == {"6"}
    assert analysis.main([str(folder / "rounds.csv")]) == 0
    said = capsys.readouterr().out
    assert said.startswith("4 finished participants, 8 rounds\n")
    assert "answer_1\n  none       n = 2   6 ± 0" in said
    (folder / "rounds.csv").write_text("a,b\n1,2\n")
    assert analysis.main([str(folder / "rounds.csv")]) == 2


def test_means_have_the_intervals_of_the_textbook() -> None:
    """Student's t: 4.303 for two degrees of freedom, 2.262 for nine."""
    found = analysis.estimate([1.0, 2.0, 3.0])
    assert (found.mean, round(found.half_width or 0, 3)) == (2.0, round(4.3027 / 3**0.5, 3))
    assert round(analysis.estimate([float(i % 2) for i in range(10)]).half_width or 0, 4) == round(
        2.26216 * (10 / 36) ** 0.5 / 10**0.5, 4
    )
    assert analysis.difference([3.0, 5.0], [1.0, 1.0]).mean == 3.0
    assert analysis.estimate([1.0]).half_width is None


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
