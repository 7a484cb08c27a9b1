"""Rounds and studies behind the page: what the person knows, what is recorded, who gets what."""

import json
from collections import Counter
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import connect

import serendipity
from serendipity.cli.app import main
from serendipity.live.play.balance import condition, order
from serendipity.live.play.questions import texts
from serendipity.live.play.records import as_csv, read
from serendipity.live.play.setting import CONDITIONS, Setting
from serendipity.live.play.study import Study
from serendipity.live.play.table import Table
from serendipity.model import InputError, UsageError
from tests.live.play_tasks import DOMAIN, two_goals, with_third_kit
from tests.live.server import serving

TO_HALL4 = [f"go to hall{i}" for i in (8, 7, 6, 5, 4)]
TO_ROOM1 = ["go to hall3", "go to hall2", "go to hall1", "go to room1", "conduct triage room1"]


def setting(**changes: Any) -> Setting:
    task = serendipity.example("room2")
    return Setting(**{"name": "room2", "task": task, "discount": Fraction(3, 5), **changes})


def go(host: Table | Study, *texts: str) -> dict[str, Any]:
    """Choose by what the page shows; what it shows then."""
    for text in texts:
        view = host.view()
        choice = next(choice for choice in view["can"] if choice["text"] == text)
        sent = {"do": "act", "round": view["round"], "epoch": view["epoch"], "action": choice["action"]}
        assert host.do(sent) is None
    return host.view()


def test_the_papers_example() -> None:
    table = Table(setting())
    view = go(table, *TO_HALL4)
    assert view["can"][0] == {
        "action": "hand_over robot commx mk2 hall4",
        "text": "hand over mk2",
        "with": "robot",
        "kind": "offer",
        "cost": 1.0,
        "place": None,
    }
    end = go(table, "hand over mk2", *TO_ROOM1)["end"]
    assert (end["paid"], end["team"], end["alone"], end["saved"]) == (11.0, 12.6, 13.0, 0.4)
    assert [(step["epoch"], step["text"]) for step in end["help"]][-1] == (
        6,
        "commx and robot: hand over mk2",
    )
    told = table.do({"do": "explain"})
    assert told is not None
    assert any("12.6" in sentence["text"] for sentence in told["sentences"])


@pytest.mark.parametrize(
    ("name", "team", "said"),
    [("none", 13.0, False), ("silent", 12.6, False), ("announced", 12.6, True)],
)
def test_what_robots_do_in_each_condition(name: str, team: float, said: bool) -> None:
    table = Table(setting(condition=name))
    view = go(table, *TO_HALL4)
    assert (view["said"] is not None) is said
    helped = name != "none"
    assert (view["can"][0]["kind"] == "offer") is helped
    if helped:
        view = go(table, "hand over mk2", *TO_ROOM1)
    else:
        view = go(table, "go to hall3", "go to hall2", "go to room2", "pick up medkit mk1", "go to hall2")
        view = go(table, "go to hall1", "go to room1", "conduct triage room1")
    assert view["end"]["team"] == team
    assert view["end"]["helped"] is helped


def test_several_robots_speak_one_after_the_other() -> None:
    table = Table(setting(name="taxis", task=serendipity.example("taxis"), discount=1, condition="announced"))
    said = table.view()["said"]
    assert said is not None
    assert "I am" not in said
    assert said.startswith(("uno is going to ", "due is going to "))


def test_somebody_with_a_local_view_knows_what_they_saw_last() -> None:
    table = Table(setting(view="local"))
    view = go(table, *TO_HALL4[:4])
    assert len(view["map"]["remembered"]) == 3, "the robot and both medkits"
    assert not any(entry["others"] for entry in view["log"])
    view = go(table, TO_HALL4[4])
    assert view["log"][0]["others"] == ["robot: go to hall4"]
    assert view["map"]["remembered"] == ["object-0"]
    view = go(table, "hand over mk2", "go to hall3")
    assert view["map"]["remembered"] == ["agent-1", "object-0"], "mk2 has come along"


def test_turning_off_towards_another_kit(tmp_path: Path) -> None:
    task = serendipity.load_pddl(DOMAIN, with_third_kit(tmp_path, "room6"), "commx", ["robot"])
    table = Table(setting(task=task))
    view = go(table, "go to hall8", "go to hall7", "go to room7", "go to room6", "pick up medkit mk3")
    assert view["thinking"]["verdict"] == "aside"
    view = go(table, "go to room7", "go to hall7", "go to hall6", "go to hall5", "go to hall4", *TO_ROOM1)
    assert view["end"]["paid"] == 15.0, "nothing that was his has become dearer"


def test_two_goals(tmp_path: Path) -> None:
    problem = with_third_kit(tmp_path, "room8", robot="room3")
    task = serendipity.load_pddl(DOMAIN, problem, "commx", ["robot"])
    table = Table(setting(task=task, goals=two_goals(tmp_path), deadline=0.5))
    assert [goal["share"] for goal in table.view()["thinking"]["goals"]] == [0.5, 0.5]
    view = go(table, *TO_HALL4, "hand over mk2", *TO_ROOM1)
    assert view["end"]["team"] == 12.2
    said = [event["verdict"] for event in table.events() if event["event"] == "epoch"]
    assert said[:3] == ["unsure", "unsure", "helps"]


@pytest.mark.parametrize(
    "message",
    [
        {},
        {"do": "fly"},
        {"do": "explain"},
        {"do": ["act"]},
        {"do": "act", "round": 1, "epoch": 1, "action": 3},
        {"do": "act", "round": 1, "epoch": 1, "action": "fly"},
    ],
    ids=str,
)
def test_what_a_page_can_not_ask_for(message: dict[str, Any]) -> None:
    table = Table(setting())
    with pytest.raises(UsageError):
        table.do(message)
    assert table.view()["epoch"] == 1


def test_of_two_pages_the_slower_one_does_nothing() -> None:
    table = Table(setting())
    sent = {"do": "act", "round": 1, "epoch": 1, "action": "move commx room13 hall8"}
    assert table.do(sent) is None
    assert table.do(sent) == {}
    assert table.view()["epoch"] == 2


# -- studies


def test_conditions_are_balanced_in_every_block() -> None:
    names = tuple(CONDITIONS)
    drawn = [condition(i, names, seed=7) for i in range(30)]
    for block in range(10):
        assert sorted(drawn[3 * block : 3 * block + 3]) == sorted(names)
    assert len({tuple(drawn[3 * block : 3 * block + 3]) for block in range(10)}) > 1


@pytest.mark.parametrize("count", range(1, 8))
def test_orders_are_balanced(count: int) -> None:
    rows = [order(row, count) for row in range(count * (1 + count % 2))]
    assert all(sorted(row) == list(range(count)) for row in rows)
    for place in range(count):
        assert len(set(Counter(row[place] for row in rows).values())) == 1
    behind = Counter(pair for row in rows for pair in pairwise(row))
    assert len(behind) == count * (count - 1)
    assert len(set(behind.values())) <= 1


def study(folder: Path, rounds: int = 2) -> Study:
    settings = [setting(name=f"room2-{i}") for i in range(rounds)]
    return Study(settings, folder, texts(folder), seed=3)


def test_a_participant_from_consent_to_the_end(tmp_path: Path) -> None:
    (tmp_path / "questions.txt").write_text("Was it good?\n\nAgain?\n")
    host = study(tmp_path)
    assert host.view()["stage"] == "consent"
    with pytest.raises(UsageError, match="consent"):
        host.do({"do": "go on"})
    host.do({"do": "go on", "agree": True})
    for number in (1, 2):
        view = host.view()
        assert (view["stage"], view["round"], view["thinking"], view["condition"]) == (
            "play",
            number,
            None,
            None,
        )
        with pytest.raises(UsageError):
            host.do({"do": "go on"})
        way = ["go to hall3", "go to hall2", "go to room2", "pick up medkit mk1", "go to hall2"]
        go(host, *TO_HALL4, *way, "go to hall1", "go to room1", "conduct triage room1")
        host.do({"do": "go on"})
        for wrong in (None, [1], [0, 1], [8, 1], [True, 1], ["1", 1], [1.5, 1]):
            with pytest.raises(UsageError, match="answers"):
                host.do({"do": "go on", "round": number, "answers": wrong})
        host.do({"do": "go on", "round": number, "answers": [3, 7], "comment": 'fine, "really"'})
    assert host.view()["stage"] == "end"
    events = host.events()
    assert events == read(tmp_path / "P001.jsonl")
    assert {event["participant"] for event in events} == {"P001"}
    assert [event["seconds"] for event in events] == sorted(event["seconds"] for event in events)
    assert len(as_csv(events).splitlines()) == 1 + len(events)
    host.do({"do": "go on"})
    assert host.view()["study"]["participant"] == "P002"


def test_what_was_recorded_outlives_the_server(tmp_path: Path) -> None:
    host = study(tmp_path)
    host.do({"do": "go on", "agree": True})
    go(host, *TO_HALL4)
    with (tmp_path / "P001.jsonl").open("a") as file:
        file.write('{"event": "ep')  # the power fails
    later = study(tmp_path)
    assert [event["event"] for event in later.events()] == ["consent", "begun", *["epoch"] * 5]
    assert later.view()["study"]["participant"] == "P002"
    (tmp_path / "P002.jsonl").write_text("{}\nnonsense\n")
    with pytest.raises(InputError, match=r"P002.jsonl:2: expected an event"):
        later.events()


def test_the_condition_is_not_told(tmp_path: Path) -> None:
    host = study(tmp_path)
    host.do({"do": "go on", "agree": True})
    shown = json.dumps({**host.view(), "map": None})
    assert not any(f'"{name}"' in shown for name in CONDITIONS)


# -- the command


@pytest.mark.parametrize(
    ("words", "start"),
    [
        (["--view", "x"], "--view: expected one of observant, local"),
        (["--robots-are", "x"], "--robots-are: expected one of none, silent, announced"),
        (["--discount", "2"], "discount: expected a number in [0, 1]"),
        (["--rounds", "0"], "--rounds: expected a number from 1 to 50"),
        (["--study", "here", "--example", "room2"], "--study: has scenarios of its own"),
        (["--study", "here", "--goals", "x"], "--goals: goes with a task"),
        (["--study", "{file}/x"], "--study: "),
        (["--records", "{file}/x"], "--records: "),
        (["--goals", "none.txt"], "none.txt: "),
        (["--example", "nowhere"], "example: expected one of"),
        (["--port", "-1"], "--port: expected a number"),
    ],
)
def test_wrong_words_are_one_line(
    words: list[str], start: str, tmp_path: Path, capsys, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    given = [word.replace("{file}", str(tmp_path / "file")) for word in words]
    assert main(["play", "--quiet", *given]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"Error: {start}")
    assert said.count("\n") == 1


def test_what_was_played_outlives_a_server_that_is_killed() -> None:
    with serving(command="play") as server:
        with connect(server.url.replace("http", "ws") + "/live") as page:
            view = json.loads(page.recv())
            for action in ("move commx room13 hall8", "move_reverse commx hall8 hall7"):
                sent = {"do": "act", "round": view["round"], "epoch": view["epoch"], "action": action}
                page.send(json.dumps(sent))
                view = json.loads(page.recv())
        shown = server.client.get("/export.json").json()
        server.process.kill()
        (file,) = server.folder.glob("serendipity-play/*.jsonl")
        assert read(file) == shown
        assert [event["event"] for event in shown] == ["begun", "epoch", "epoch"]


def test_a_map_has_room_for_all_that_comes_together_and_never_shrinks() -> None:
    table = Table(setting(name="taxis", task=serendipity.example("taxis"), discount=1))
    widths = [table.view()["map"]["width"]]
    while (view := table.view())["end"] is None:
        able = [choice for choice in view["can"] if choice["kind"] in ("offer", "go")] or view["can"]
        sent = {"do": "act", "round": 1, "epoch": view["epoch"], "action": able[0]["action"]}
        table.do(sent)
        widths.append(table.view()["map"]["width"])
        if len(widths) > 15:
            break
    assert widths == sorted(widths)


def test_a_port_in_use_is_one_line(capsys, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with serving(command="play") as server:
        assert main(["play", "--quiet", "--port", str(server.port)]) == 2
        assert capsys.readouterr().err.startswith(f"Error: --port: {server.port} is in use on 127.0.0.1")
        assert server.client.get("/", headers={"host": "evil.example"}).status_code == 400
        assert server.client.get("/", headers={"origin": "http://evil.example"}).status_code == 403
        assert "http" not in server.client.get("/").text.replace("http://www.w3.org", "")
        assert server.client.get("/page/../../../../etc/passwd").status_code == 404
        assert server.client.get("/page/nothing.js").status_code == 404
