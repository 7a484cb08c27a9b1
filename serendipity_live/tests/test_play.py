"""Rounds behind the page: what the person knows and reads, what is recorded, how a round goes on."""

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import connect

import serendipity
from serendipity.cli.app import main
from serendipity.model import InputError, UsageError
from serendipity.scenarios.examples import EXAMPLES
from serendipity_live.play.application import Room
from serendipity_live.play.labels import DomainLabels, labels_for
from serendipity_live.play.map_view import Knowledge
from serendipity_live.play.records import as_csv, read
from serendipity_live.play.round import RoundSetting
from serendipity_live.play.rounds import SharedRounds
from serendipity_live.tests.play_tasks import DOMAIN, TAKE, two_goals, with_third_kit
from serendipity_live.tests.server import serving
from serendipity_testing.builders import task as build
from tests.search.time.test_people_who_see_what_is_near import kitchen

TO_HALL4 = [f"go to hall{i}" for i in (8, 7, 6, 5, 4)]
TO_ROOM1 = ["go to hall3", "go to hall2", "go to hall1", "go to room1", "give treatment in room1"]


def setting(**changes: Any) -> RoundSetting:
    task = changes.pop("task", None) or serendipity.example("room2")
    labels = labels_for(task)
    return RoundSetting(
        **{"name": "room2", "task": task, "discount": Fraction(3, 5), "labels": labels, **changes}
    )


def go(host: Room, *texts: str) -> dict[str, Any]:
    """Choose by what the page shows; what it shows then."""
    for text in texts:
        view = host.view()
        choice = next(choice for choice in view["can"] if choice["text"] == text)
        assert host.do({"do": "act", "moment": view["moment"], "action": choice["action"]}) is None
    return host.view()


def test_the_papers_example() -> None:
    table = SharedRounds(setting())
    view = go(table, *TO_HALL4)
    assert view["can"][0] == {
        "action": "hand_over robot commx mk2 hall4",
        "text": TAKE,
        "with": "the robot",
        "kind": "offer",
        "cost": 1.0,
        "place": None,
    }
    end = go(table, TAKE, *TO_ROOM1)["end"]
    assert (end["paid"], end["team"], end["alone"], end["saved"]) == (11.0, 12.6, 13.0, 0.4)
    assert [(step["epoch"], step["text"]) for step in end["help"]][-1] == (6, f"commx and robot: {TAKE}")
    told = table.do({"do": "explain"})
    said = [sentence["text"] for sentence in told["sentences"] if sentence["topic"] == "run"]
    assert said[0] == "Epoch 1: waits: its part comes in epoch 2." and "mk2" in said[1]
    assert said[-1] == "commx paid 11 instead of 13 alone, the team 12.6."


@pytest.mark.parametrize(
    ("name", "team", "said"), [("none", 13.0, False), ("silent", 12.6, False), ("announced", 12.6, True)]
)
def test_what_robots_do_in_each_condition(name: str, team: float, said: bool) -> None:
    table = SharedRounds(setting(condition=name))
    view = go(table, *TO_HALL4)
    helped = name != "none"
    assert ((view["said"] is not None), view["can"][0]["kind"] == "offer") == (said, helped)
    if helped:
        view = go(table, TAKE, *TO_ROOM1)
    else:
        view = go(table, "go to hall3", "go to hall2", "go to room2", "pick up medkit mk1", "go to hall2")
        view = go(table, "go to hall1", "go to room1", "give treatment in room1")
    assert (view["end"]["team"], view["end"]["helped"] > 0) == (team, helped)


def test_several_robots_speak_one_after_the_other() -> None:
    table = SharedRounds(
        setting(name="taxis", task=serendipity.example("taxis"), discount=1, condition="announced")
    )
    said = table.view()["said"]
    assert "I will" not in said
    assert said.startswith(("Uno will ", "Due will "))


def test_somebody_with_a_local_view_knows_what_they_saw_last() -> None:
    table = SharedRounds(setting(view="local"))
    view = go(table, *TO_HALL4[:4])
    assert len(view["map"]["remembered"]) == 3, "the robot and both medkits"
    assert not any(entry["others"] for entry in view["log"])
    view = go(table, TO_HALL4[4])
    assert view["log"][0]["others"] == ["the robot: go to hall4"]
    assert view["map"]["remembered"] == ["object-0"]
    view = go(table, TAKE, "go to hall3")
    assert view["map"]["remembered"] == ["agent-1", "object-0"], "mk2 has come along"


def test_turning_off_towards_another_kit(tmp_path: Path) -> None:
    task = serendipity.load_pddl(DOMAIN, with_third_kit(tmp_path, "room6"), "commx", ["robot"])
    table = SharedRounds(setting(task=task))
    view = go(table, "go to hall8", "go to hall7", "go to room7", "go to room6", "pick up medkit mk3")
    assert view["thinking"]["verdict"] == "stopped"
    view = go(table, "go to room7", "go to hall7", "go to hall6", "go to hall5", "go to hall4", *TO_ROOM1)
    assert view["end"]["paid"] == 15.0, "nothing that was his has become dearer"


def test_two_goals(tmp_path: Path) -> None:
    problem = with_third_kit(tmp_path, "room8", robot="room3")
    task = serendipity.load_pddl(DOMAIN, problem, "commx", ["robot"])
    table = SharedRounds(setting(task=task, goals=two_goals(tmp_path), deadline=0.5))
    assert [goal["share"] for goal in table.view()["thinking"]["goals"]] == [0.5, 0.5]
    view = go(table, *TO_HALL4, TAKE, *TO_ROOM1)
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
        {"do": "act", "moment": "1.1", "action": 3},
        {"do": "act", "moment": "1.1", "action": "fly"},
    ],
    ids=str,
)
def test_what_a_page_can_not_ask_for(message: dict[str, Any]) -> None:
    table = SharedRounds(setting())
    with pytest.raises(UsageError):
        table.do(message)
    assert table.view()["epoch"] == 1


def test_what_is_chosen_twice_or_for_another_epoch_does_nothing() -> None:
    table = SharedRounds(setting())
    sent = {"do": "act", "moment": "1.1", "action": "move commx room13 hall8"}
    assert table.do(sent) is None
    assert table.do(sent) == {}
    assert table.view()["epoch"] == 2


def test_robots_that_announce_their_plan_count_on_somebody_who_knows_it() -> None:
    """In III-D nothing helps without a word, and 12.6 of 13 is paid where the robot's plan is known."""
    told = setting(task=serendipity.example("room7"), condition="announced").execution()
    silent = setting(task=serendipity.example("room7")).execution()
    assert (told.options.human_model, silent.options.human_model) == ("omniscient", "observant")
    table = SharedRounds(setting(name="announced", condition="announced"))
    said = table.view()["said"]
    assert said.startswith("I will ")
    assert "hand medkit mk2 to you (epoch 6)" in said
    assert said.endswith("Please go to hall8 now.")


def test_robots_that_announce_what_they_do_say_that_they_have_stopped(tmp_path: Path) -> None:
    task = serendipity.load_pddl(DOMAIN, with_third_kit(tmp_path, "room6"), "commx", ["robot"])
    table = SharedRounds(setting(task=task, condition="announced"))
    view = go(table, *TO_HALL4[:2], "go to room7", "go to room6", "pick up medkit mk3")
    while view["thinking"]["verdict"] != "stopped":
        view = go(table, "wait")
    assert view["said"].startswith("I have stopped helping")


def test_a_round_goes_on_from_its_record(tmp_path: Path) -> None:
    file = tmp_path / "record.jsonl"
    before = go(SharedRounds(setting(), file), *TO_HALL4)
    again = SharedRounds(setting(), file)
    view = again.view()
    assert {**view, "thinking": None} == {**before, "thinking": None}
    assert go(again, TAKE, *TO_ROOM1)["end"]["team"] == 12.6
    assert SharedRounds(setting(), file).view()["moment"] == "2.1", "that round is over"
    with pytest.raises(InputError, match="of another task, or was played otherwise"):
        SharedRounds(setting(discount=Fraction(1, 2)), file)
    file.write_text(file.read_text().replace("move_reverse commx hall8 hall7", "move commx hall8 room8"))
    events, _ = read(file)
    file.write_text(
        "".join(json.dumps(e) + "\n" for e in events if e.get("round") == 1 and e["event"] != "again")
    )
    with pytest.raises(InputError, match="epoch 2: comes out otherwise than it is recorded"):
        SharedRounds(setting(), file)


def test_what_was_shown_and_said_is_recorded() -> None:
    table = SharedRounds(setting(condition="announced"))
    go(table, *TO_HALL4)
    last = table.events()[-1]
    assert last["choices"] == ["go to hall6", "go to hall4", "go to room12", "go to room5", "wait"]
    assert last["said"].startswith("I will ")
    assert table.events()[4]["seen"] == ["the robot: go to hall4"]
    assert last["goal"] == [{"text": "Treat the patient in room1", "holds": False}]


def test_a_bad_line_spoils_nothing_but_itself(tmp_path: Path) -> None:
    file = tmp_path / "P001.jsonl"
    file.write_bytes(b'{"event": "a"}\nnonsense\n\xff\n[1]\n{"event": "b"}\n{"event": "c')
    events, faults = read(file)
    assert [event["event"] for event in events] == ["a", "b"]
    assert [fault.split(": ")[0] for fault in faults] == [f"P001.jsonl:{n}" for n in (2, 3, 4)]
    assert file.read_bytes().endswith(b'"c\n'), "what is added begins a line of its own"


def test_csv_has_what_json_has() -> None:
    events = [
        {"event": "a", "order": ["x", "y"], "seconds": 0.5},
        {"event": "b", "goals": {"g": 1}, "n": None},
    ]
    head, first, second = as_csv(events).splitlines()
    assert set(head.split(",")) >= {key for event in events for key in event}
    assert '"[""x"", ""y""]"' in first
    assert '"{""g"": 1}"' in second


# -- words


@pytest.mark.parametrize("name", EXAMPLES)
def test_shipped_domains_have_sentences_for_everything(name: str) -> None:
    task = serendipity.example(name)
    labels = labels_for(task)
    assert labels.complete(task)
    assert labels.about
    if not task.needs_time:  # what does is not played yet
        view = SharedRounds(setting(name=name, task=task)).view()
        texts = [part["text"] for part in (*view["goal"], *view["can"])]
        assert not any(mark in text for text in texts for mark in "_{}")


def test_sentences_of_a_file(tmp_path: Path) -> None:
    task, file = serendipity.example("room2"), tmp_path / "labels.toml"
    file.write_text('[things]\nmk = "the kit {}"\n[actions]\npick_up_medkit = "take {1}"\n')
    view = SharedRounds(setting(labels=labels_for(task, file))).view()
    assert view["goal"][0]["text"] == "conducted triage room1", "what has no label is said by its name"
    assert DomainLabels(things={"mk": "the kit {}"}).thing("mk12") == "the kit mk12"
    (tmp_path / "ground").mkdir()
    assert DomainLabels(actions={"pick_up": ["get {1}"]}).action("pick_up_commx_mk1") == (
        ["get {1}"],
        ("commx", "mk1"),
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[actions", "expected TOML: "),
        ("verbs = 1", "verbs: extra inputs are not permitted"),
        ("[actions]\nmove = 3", "actions.move"),
        ("[actions]\nmove = '{who}'", "actions.move: expected {0}, {1} ... only"),
        ("[actions]\nmove = '{'", "actions.move: expected {0}, {1} ... only"),
        ("[actions]\nmove = []", "actions.move: expected a sentence"),
        ("[actions]\nmove = '{3}'", "actions.move: there is no {3}, only 3 arguments"),
        ("[goals]\nconducted_triage = '{2}'", "goals.conducted_triage: there is no {2}"),
    ],
)
def test_wrong_labels_are_one_line(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "labels.toml"
    file.write_text(text)
    with pytest.raises(InputError, match="labels") as told:
        labels_for(serendipity.example("room2"), file)
    assert str(told.value).startswith(f"{file}: {said}")
    assert "\n" not in str(told.value)


# -- the command


@pytest.mark.long
def test_what_was_played_outlives_a_server_that_is_killed() -> None:
    with serving(command="play") as server:
        with connect(server.url.replace("http", "ws") + "/live") as page:
            view = json.loads(page.recv())
            page.send(b"\0")
            assert json.loads(page.recv())["kind"] == "refused"
            for action in ("move commx room13 hall8", "move_reverse commx hall8 hall7"):
                page.send(json.dumps({"do": "act", "moment": view["moment"], "action": action}))
                view = json.loads(page.recv())
        shown = server.client.get("/export.json").json()
        server.process.kill()
        (file,) = server.folder.glob("serendipity-play/*.jsonl")
        assert read(file) == (shown, [])
        assert [event["event"] for event in shown] == ["begun", "epoch", "epoch"]


@pytest.mark.long
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


@pytest.mark.parametrize("option", ["--labels", "--goals"])
def test_what_can_not_be_played_leaves_no_folder(
    option: str, capsys, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["play", "--quiet", "--port", "0", option, "nowhere"]) == 2
    assert "nowhere" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_what_changes_nothing_is_no_choice() -> None:
    there = {f"go h {a} {b}": f"at_h_{a} -> at_h_{b}" + f" !at_h_{a}" * (a != b) for a in "ab" for b in "ab"}
    task = build(init="at_h_a", goal="at_h_b", actions={**there, "wave r": "-> waved"})
    view = SharedRounds(RoundSetting("here", task, Fraction(1, 2))).view()
    assert [choice["text"] for choice in view["can"]] == ["go to b", "wait"]


def test_a_day_with_a_clock() -> None:
    table = SharedRounds(setting(task=serendipity.example("morning"), name="morning"))
    view = table.view()
    assert (view["clock"], view["busy"], [choice["kind"] for choice in view["can"]]) == ("0", False, ["wait"])
    for _ in range(3):
        view = go(table, "wait")
    assert "now: awake ann" in view["log"][0]["others"] and view["going"]
    view = go(table, next(choice["text"] for choice in view["can"] if "(2 epochs)" in choice["text"]))
    assert view["busy"] and (view["clock"], len(view["can"])) == ("8", 1)
    view = go(table, view["can"][0]["text"])
    assert not view["busy"] and view["log"][0]["you"].startswith("went on: ")


def test_bystanders_are_seen_once_they_begin() -> None:
    table = SharedRounds(setting(task=serendipity.example("office"), name="office"))
    seen = [line for _ in range(3) for line in go(table, "wait")["log"][0]["others"]]
    assert seen == ["Carl: walk to the lobby", "Carl: take the lift to the landing"]


def test_what_somebody_on_the_way_knows_of_a_day() -> None:
    """It was refused.  They are not there before the walk is over, and see then what the robot has cooked."""
    task = kitchen(walk=3)
    table = SharedRounds(RoundSetting("dinner", task, Fraction(1, 2), view="local"))
    known, run = Knowledge(task, "local"), serendipity.Execution(task, discount=0.5, human_model="local")
    walk = task.actions[task.named["walk ann hall kitchen"][0]]
    there = []
    for epoch in range(3):
        run.step(None if epoch else walk.name)
        view = go(table, table.view()["can"][0]["text"])
        known.look(run.now, None if epoch else walk)
        there.append(task.facts.index("at ann kitchen") in known.belief)
    assert there == [False, False, True] and not view["busy"]
    while "warm soup" not in run.facts:
        run.step(None)
        known.look(run.now, None)
    assert known.belief == run.state


def test_what_is_not_played_in_time_is_said() -> None:
    with pytest.raises((UsageError, InputError), match="goals"):
        SharedRounds(setting(task=serendipity.example("morning"), goals=[])).view()
