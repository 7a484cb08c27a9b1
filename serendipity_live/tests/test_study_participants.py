"""Those who take part in a study: their places, their way through it, what outlives a server.

What can't be written down has not happened: who asks again once there is room goes on.
"""

import errno
import json
import os
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

import serendipity
from serendipity.model import UsageError
from serendipity_live.play.records import Records, read
from serendipity_live.play.round import CONDITIONS, RoundSetting
from serendipity_live.play.rounds import SharedRounds
from serendipity_live.study.design import open_design
from serendipity_live.study.participant import Participant
from serendipity_live.study.study import Study
from serendipity_live.tests.server import serving
from serendipity_live.tests.studies import PLAIN, act_along, finish, join, opened, say
from tests.writing.full_disk import largest_file


def test_who_withdraws_gives_their_place_back(folder: Path) -> None:
    study = opened(folder, seed=3)
    people = [join(study) for _ in range(3)]
    assert [p.joined["place"] for p in people] == [0, 1, 2]
    assert say(people[1], "withdraw")["stage"] == "withdrawn"
    assert [join(study).joined["place"] for _ in range(2)] == [1, 3]
    assert study.state(people[1]) == "withdrawn"


def test_who_is_not_heard_of_for_long_gives_their_place_back_and_may_come_back(folder: Path) -> None:
    (folder / "study.toml").write_text("lost_after_minutes = 60\n" + PLAIN)
    study = opened(folder)
    lost = join(study)
    say(lost, "go on")
    file = folder / "P001.jsonl"
    file.write_text(file.read_text().replace(lost.joined["time"][:10], "2020-01-01"))
    study = opened(folder)
    again = study.room(lost.joined["token"])
    assert isinstance(again, Participant)
    assert study.state(again) == "lost"
    assert join(study).joined["place"] == lost.joined["place"]
    again.do({"do": "hello", "page": {"browser": "Lynx"}})
    assert study.state(again) == "under way"
    assert again.view()["stage"] == "play"


# -- on the way


def test_a_participant_from_consent_to_the_end(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    lobby = study.room("")
    with pytest.raises(UsageError, match="consent"):
        lobby.do({"do": "join"})
    room = join(study, page={"browser": "Lynx", "screen": "80x24", "more": 1})
    assert "pick one up" in " ".join(room.view()["study"]["text"]), "of the domain"
    say(room, "go on")
    for number in (1, 2):
        with pytest.raises(UsageError):
            say(room, "go on")
        act_along(room, design)
        assert say(room, "go on")["stage"] == "questions"
        for wrong in (None, [1], [0, ""], [8, ""], [True, ""], ["1", ""], [1.5, ""], [1, 3]):
            with pytest.raises(UsageError, match="answers"):
                say(room, "answer", answers=wrong)
        say(room, "answer", answers=[number, ""], times=[700, None])
    assert room.view()["stage"] == "closing"
    with pytest.raises(UsageError, match="expected one of me, you"):
        say(room, "answer", answers=["they"])
    assert say(room, "answer", answers=["you"])["study"]["code"] == design.code
    events = room.events()
    assert [json.loads(line) for line in (folder / "P001.jsonl").read_text().splitlines()] == events
    joined = events[0]
    assert (joined["browser"], joined["screen"], joined["version"]) == (
        "Lynx",
        "80x24",
        serendipity.__version__,
    )
    assert joined["consent"] == design.texts.consent
    assert joined["study"] == design.mark
    kinds = Counter(event["event"] for event in events)
    assert (kinds["asked"], kinds["answers"], kinds["begun"], kinds["end"]) == (3, 3, 2, 1)
    told = next(event for event in events if event["event"] == "answers")
    assert told["answers"][0] == {"question": "Was it good?", "answer": 1, "page_seconds": 0.7}
    assert all(event["page_seconds"] == 1.5 for event in events if event["event"] == "epoch")


def test_practice_comes_first_and_says_what_would_have_been_best(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('conditions = ["none", "silent"]')
    design = open_design(tmp_path, rounds=1, seed=1)
    room = join(Study(design, tmp_path))
    assert "practice" in room.view()["study"]["text"][-1]
    assert say(room, "go on")["round"] == 0
    for action in serendipity.plan(design.practice.task, mode="individual").human_plan or ():
        view = say(room, "act", action=action)
    assert view["end"]["alone"] == view["end"]["paid"]
    assert say(room, "go on")["round"] == 1, "without questions"


def test_a_page_in_a_study_is_told_nothing_of_conditions_and_of_what_robots_think(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    for _ in range(2):
        room = join(study)
        say(room, "go on")
        shown = [room.view()]
        act_along(room, design)
        shown.append(room.view())
        text = json.dumps([{**view, "map": None} for view in shown])
        for word in (*CONDITIONS, "thinking", "reason", "alone", "team", "discount", "window", "handed over"):
            assert f'"{word}"' not in text


def test_what_comes_twice_or_too_late_is_kept_once(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    lobby = study.room("")
    for visit in ("0.5", "long" * 100):
        sent = {"do": "join", "agree": True, "visit": visit}
        assert lobby.do(sent) == lobby.do(sent)
    room = join(study)
    first = {"do": "go on", "moment": room.view()["moment"]}
    assert room.do(first) is None
    assert room.do(first) == {}
    act_along(room, design)
    say(room, "go on")
    answer = {"do": "answer", "moment": room.view()["moment"], "answers": [3, ""]}
    assert room.do(answer) is None
    assert room.do(answer) == {}
    assert Counter(event["event"] for event in room.events())["answers"] == 1


def test_a_link_from_elsewhere_leads_to_the_same_person(folder: Path) -> None:
    study = opened(folder)
    one = join(study, address={"PROLIFIC_PID": "abc", "x": "y"})
    assert join(study, address={"PROLIFIC_PID": "abc"}) is one
    assert join(study, address={"PROLIFIC_PID": "abd"}) is not one
    assert join(study) is not join(study)
    assert study.room("abc") is None


def test_the_link_at_the_end_has_their_code_and_id(tmp_path: Path) -> None:
    text = 'completion_code = "A&1"\ncompletion_link = "https://example.org/?cc={code}&who={id}"\n'
    (tmp_path / "study.toml").write_text(text + PLAIN)
    study, design = opened(tmp_path), open_design(tmp_path)
    ends = []
    for address in ({"id": "a@b+c"}, {}):
        room = join(study, address=address)
        assert "link" not in room.view()["study"]
        finish(room, design)
        ends.append(room.view()["study"]["link"])
    assert ends == ["https://example.org/?cc=A%261&who=a%40b%2Bc", "https://example.org/?cc=A%261&who="]


@pytest.mark.parametrize("given", ["{{%PROLIFIC_PID%}}", "a b", "a" * 101, "é", "a\n", ["a"]])
def test_an_id_that_is_none_is_one_line_and_nobody_has_joined(folder: Path, given: object) -> None:
    study = opened(folder)
    with pytest.raises(UsageError, match=r"^participant: expected at most 100 letters[^\n]*$"):
        join(study, address={"participant": given})
    assert study.events() == []
    assert not list(folder.glob("P*.jsonl"))


def test_a_round_that_has_no_end_ends(folder: Path) -> None:
    (folder / "study.toml").write_text("most_epochs = 20\n" + PLAIN)
    room = join(opened(folder))
    say(room, "go on")
    for _ in range(20):
        view = say(room, "act", action=None)
    assert (view["done"], view["end"]["reached"]) == (True, False)
    assert say(room, "go on")["stage"] == "questions"


@pytest.mark.long
def test_several_take_part_at_once(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    with ThreadPoolExecutor(6) as pool:
        rooms = list(pool.map(lambda _: join(study), range(6)))
        list(pool.map(lambda room: finish(room, design), rooms))
    assert sorted(room.joined["place"] for room in rooms) == list(range(6))
    assert len({room.name for room in rooms}) == 6
    assert all(room.stage == "end" for room in rooms)


@pytest.mark.long
def test_whatever_a_page_sends_it_is_answered_and_can_be_saved(folder: Path) -> None:
    """Halves of characters, which no file takes, and links of nobody."""
    (folder / "study.toml").write_text(PLAIN[: PLAIN.rindex("[[scenarios]]")])
    study, design = opened(folder), open_design(folder)
    room = join(study)
    say(room, "go on")
    act_along(room, design)
    say(room, "go on")
    with serving("--study", str(folder), command="play") as server:
        live = server.url.replace("http", "ws") + "/live/"
        with connect(live + room.joined["token"]) as page:
            moment = json.loads(page.recv())["moment"]
            for text in ("[" * 20_000, "3", json.dumps({"do": "\ud800", "moment": moment})):
                page.send(text)
                assert json.loads(page.recv())["kind"] == "refused"
            page.send(json.dumps({"do": "answer", "moment": moment, "answers": [3, "a\ud800b"]}))
            assert json.loads(page.recv())["stage"] == "closing"
        saved = server.client.get(f"/experimenter/{design.secret}/events.json").json()
        told = next(event for event in saved if event["event"] == "answers")
        assert told["answers"][1]["answer"] == "a?b"
        assert server.client.get("/s/nobody").status_code == 404
        with pytest.raises(InvalidStatus):
            connect(live + "nobody")


@pytest.mark.long
def test_neither_the_log_nor_the_files_tell_others_the_secrets(folder: Path) -> None:
    design, room = open_design(folder), join(opened(folder))
    with serving("--study", str(folder), "-v", command="play") as server:
        for path in (f"/s/{room.joined['token']}", f"/experimenter/{design.secret}/events.json"):
            assert server.client.get(path).status_code == 200
        _, said = server.stop()
    assert "GET /s/..." in said and "GET /experimenter/.../events.json" in said
    assert room.joined["token"] not in said and design.secret not in said
    assert not [file.name for file in folder.glob("*.json*") if file.stat().st_mode & 0o077]


# -- restarts


@pytest.mark.long
def test_a_study_goes_on_where_it_was_when_the_server_comes_back(folder: Path) -> None:
    design = open_design(folder)
    rooms = [join(opened(folder)) for _ in range(3)]
    for room, epochs in zip(rooms, (0, 6, None), strict=True):
        say(room, "go on")
        act_along(room, design, epochs)
    say(rooms[2], "go on")
    study = opened(folder)
    for before in rooms:
        after = study.room(before.joined["token"])
        assert isinstance(after, Participant)
        assert after.view() == before.view()
        finish(after, design)
        assert after.stage == "end"


@pytest.mark.long
def test_whatever_was_written_last_the_study_goes_on(folder: Path) -> None:
    """The machine fails after any line."""
    (folder / "study.toml").write_text(PLAIN[: PLAIN.rindex("[[scenarios]]")])
    room = join(opened(folder))
    finish(room, open_design(folder))
    whole = (folder / "P001.jsonl").read_text().splitlines(keepends=True)
    for lines in range(1, len(whole)):
        if '"epoch"' in whole[lines - 1] and lines % 5:
            continue
        (folder / "P001.jsonl").write_text("".join(whole[:lines]) + '{"event": "ep')
        again = opened(folder).room(room.joined["token"])
        assert isinstance(again, Participant)
        finish(again, open_design(folder))
        kinds = Counter(event["event"] for event in again.events())
        assert (kinds["begun"], kinds["answers"], kinds["end"]) == (1, 2, 1)


def test_a_record_that_is_none_harms_nobody_else(folder: Path) -> None:
    room = join(opened(folder))
    (folder / "P002.jsonl").write_bytes(b'{"event": "joined", "participant": "P002"}\n\xff\nnonsense\n')
    study = opened(folder)
    assert [fault.split(": ")[0] for fault in study.faults] == ["P002.jsonl:2", "P002.jsonl:3", "P002.jsonl"]
    assert study.room(room.joined["token"]) is not None
    assert {event["participant"] for event in study.events()} == {"P001", "P002"}
    assert join(study).name == "P003"


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
