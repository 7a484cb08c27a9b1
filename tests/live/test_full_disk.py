"""What can't be written down has not happened: who asks again once there is room goes on."""

import errno
import os
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from itertools import count
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.live.play.records import Records, read
from serendipity.live.play.round import RoundSetting
from serendipity.live.play.rounds import SharedRounds
from serendipity.live.study.design import open_design
from serendipity.live.study.participant import Participant
from serendipity.model import UsageError
from tests.live.studies import finish, join, opened
from tests.writing.full_disk import largest_file


@pytest.fixture
def often_full(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every third line finds no room, the second one first."""
    sync, lines = os.fsync, count()

    def full(file: int) -> None:
        if next(lines) % 3 == 1:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        sync(file)

    monkeypatch.setattr(os, "fsync", full)


def until_written(do: Callable[..., Any], *given: Any) -> Any:
    """What comes of it when it is asked for again and again."""
    for _ in range(5):
        try:
            return do(*given)
        except UsageError as error:
            assert "No space left" in str(error)
    pytest.fail("it never is")


@pytest.mark.usefixtures("often_full")
def test_a_line_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    records = Records("player", tmp_path / "a.jsonl")
    records.add("one")
    with pytest.raises(UsageError, match="No space left"):
        records.add("two")
    records.add("three")
    assert read(tmp_path / "a.jsonl") == (records.events, [])
    assert [event["event"] for event in records.events] == ["one", "three"]


@pytest.mark.long
def test_a_participant_goes_on(folder: Path, request: pytest.FixtureRequest, monkeypatch) -> None:
    room, do = join(opened(folder)), Participant.do
    request.getfixturevalue("often_full")
    monkeypatch.setattr(Participant, "do", lambda *given: until_written(do, *given))
    finish(room, open_design(folder))
    kinds = Counter(event["event"] for event in room.events())
    assert (kinds["begun"], kinds["round over"], kinds["answers"], kinds["end"]) == (2, 2, 3, 1)
    again = opened(folder).room(room.joined["token"])
    assert isinstance(again, Participant)
    assert (again.events(), again.view()) == (room.events(), room.view())


def test_a_player_goes_on(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    task, file = serendipity.example("room2"), tmp_path / "a.jsonl"
    setting = RoundSetting("room2", task, Fraction(3, 5))
    table = SharedRounds(setting, file)
    request.getfixturevalue("often_full")
    for action in serendipity.plan(task, mode="individual").human_plan[:3]:
        until_written(table.do, {"do": "act", "moment": table.view()["moment"], "action": action})
    shown = [rounds.view() for rounds in (table, SharedRounds(setting, file))]
    for view in shown:
        del view["thinking"]["milliseconds"]
    assert shown[0] == shown[1]
    until_written(table.do, {"do": "again"})
    assert table.view()["round"] == 2


def test_a_study_is_begun_whole_or_not_at_all(folder: Path) -> None:
    with largest_file(200), pytest.raises(UsageError, match=r"study\.json can't be written: file too large"):
        open_design(folder)
    assert [file.name for file in folder.iterdir()] == ["study.toml"]
    open_design(folder)
    assert (folder / "study.json").stat().st_mode & 0o077 == 0, "the secret is in it"
