"""Studies: what scenarios show, who gets what, what is recorded, what outlives a server, what is found."""

import json
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from itertools import islice, pairwise
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

import serendipity
from serendipity.cli.app import main
from serendipity.live.play.setting import CONDITIONS, Setting
from serendipity.live.study import analysis
from serendipity.live.study.balance import order, places
from serendipity.live.study.design import Design, open_design
from serendipity.live.study.drawing import draw
from serendipity.live.study.participant import Participant
from serendipity.live.study.rehearsal import fault, rehearse
from serendipity.live.study.study import Study
from serendipity.model import InputError, UsageError
from tests.live.server import serving

NAMES = tuple(CONDITIONS)
PLAIN = """
practice = false
conditions = ["none", "silent"]
[[questions]]
text = "Was it good?"
[[questions]]
text = "Why?"
kind = "text"
required = false
[[closing]]
text = "Who are you?"
kind = "choice"
choices = ["me", "you"]
[[scenarios]]
name = "handed over"
example = "room2"
[[scenarios]]
name = "in the way"
example = "taxis"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A study of two scenarios of its own, which are there at once."""
    (tmp_path / "study.toml").write_text(PLAIN)
    return tmp_path


def opened(folder: Path, **given: Any) -> Study:
    return Study(open_design(folder, **given), folder)


def join(study: Study, **more: Any) -> Participant:
    lobby = study.room("")
    assert lobby is not None
    answer = lobby.do({"do": "join", "agree": True, **more})
    assert answer is not None
    room = study.room(answer["to"].removeprefix("/s/"))
    assert isinstance(room, Participant)
    return room


def say(room: Participant, what: str, **more: Any) -> Mapping[str, Any]:
    room.do({"do": what, "moment": room.view()["moment"], "took": 1500, **more})
    return room.view()


def act_along(room: Participant, design: Design, epochs: int | None = None) -> None:
    """The way that is best alone."""
    events = [event for event in room.events() if event["event"] == "begun"]
    task = design.scenarios[events[-1]["scenario"]].task
    for action in (serendipity.plan(task, mode="individual").human_plan or ())[:epochs]:
        say(room, "act", action=action)


def finish(room: Participant, design: Design) -> None:
    while not room.over:
        view = room.view()
        if view["stage"] == "play" and not view["done"]:
            act_along(room, design)
        elif view["stage"] in ("play", "instructions"):
            say(room, "go on")
        else:
            one = {"scale": 6, "choice": "me", "text": "so"}
            say(room, "answer", answers=[one[question["kind"]] for question in view["study"]["questions"]])


# -- scenarios


def test_drawn_scenarios_show_what_conditions_promise() -> None:
    drawn = list(draw(2, 5, NAMES, discount=Fraction(3, 5)))
    assert len({setting.name for setting, _ in drawn}) == 2
    for setting, played in drawn:
        alone = serendipity.plan(setting.task, mode="individual").cost
        assert (played["none"].helped, played["none"].cost) == (0, alone)
        assert alone > played["silent"].cost > played["announced"].cost
        assert played == rehearse(setting, NAMES)


@pytest.mark.slow
def test_in_the_default_study_conditions_differ_in_ten_of_ten() -> None:
    for seed in (1, 2, 3):
        for _, played in draw(10, seed, NAMES, discount=Fraction(3, 5)):
            assert len({played[name].human_cost for name in NAMES}) == 3


def test_scenarios_follow_from_the_seed() -> None:
    def names(seed: int) -> list[str]:
        return [setting.name for setting, _ in draw(1, seed, ("none", "silent"), discount=Fraction(3, 5))]

    assert names(1) == names(1)
    assert names(1) != names(2)


def test_a_scenario_in_which_conditions_do_not_differ_is_refused(folder: Path, capsys) -> None:
    text = PLAIN.replace('conditions = ["none", "silent"]', "")
    (folder / "study.toml").write_text(text)
    assert main(["play", "--quiet", "--study", str(folder)]) == 2
    said = capsys.readouterr().err
    assert said == (
        "Error: scenario handed over: silent and announced come to the same when somebody plays it who"
        " plays well\n"
    )
    (folder / "study.toml").write_text(PLAIN.replace("room2", "room7"))
    with pytest.raises(UsageError, match="silent robots save nothing"):
        open_design(folder)


def test_what_is_no_scenario_of_a_condition() -> None:
    played = rehearse(Setting("taxis", serendipity.example("taxis"), Fraction(1, 2)), NAMES)
    assert fault(played, NAMES) is None
    assert fault({**played, "silent": played["none"]}, ("none", "silent")) == "silent robots save nothing"
    lost = {
        **played,
        "silent": rehearse(Setting("x", serendipity.example("room2"), Fraction(0), most_epochs=3), ())[
            "none"
        ],
    }
    assert fault(lost, ("none", "silent")) == "the goal is not reached where robots are silent"


def test_the_report_says_what_conditions_come_to(folder: Path, capsys) -> None:
    assert main(["play", "--quiet", "--study", str(folder), "--report"]) == 0
    assert (
        "condition silent helps in 2 of 2, saves 0.5 in the mean (1.5 for the person)"
        in capsys.readouterr().out
    )


# -- balance


def test_conditions_and_orders_are_balanced() -> None:
    drawn = list(islice(places(NAMES, 4, seed=7), 24))
    for block in (drawn[:12], drawn[12:]):
        assert sorted(block) == sorted((name, row) for name in NAMES for row in range(4))
    names = [name for name, _ in drawn]
    for count in range(1, 25):
        spread = Counter(names[:count])
        assert max(spread.values()) - min(spread[name] for name in NAMES) <= 2


def test_nobody_can_tell_the_next_condition_from_those_before() -> None:
    last = set()
    for seed in range(60):
        names = [name for name, _ in islice(places(NAMES, 4, seed), 3)]
        last.add(len(set(names)))
    assert last == {2, 3}, "the third is not always the one that is left"


@pytest.mark.parametrize("count", range(1, 8))
def test_orders_are_balanced(count: int) -> None:
    rows = [order(row, count) for row in range(count * (1 + count % 2))]
    assert all(sorted(row) == list(range(count)) for row in rows)
    for place in range(count):
        assert len(set(Counter(row[place] for row in rows).values())) == 1
    behind = Counter(pair for row in rows for pair in pairwise(row))
    assert len(behind) == count * (count - 1)
    assert len(set(behind.values())) <= 1


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


# -- participants


def test_a_participant_from_consent_to_the_end(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    lobby = study.room("")
    assert lobby is not None
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
    assert design.practice is not None
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
    assert lobby is not None
    sent = {"do": "join", "agree": True, "visit": "0.5"}
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


def test_a_round_that_has_no_end_ends(folder: Path) -> None:
    (folder / "study.toml").write_text("most_epochs = 20\n" + PLAIN)
    room = join(opened(folder))
    say(room, "go on")
    for _ in range(20):
        view = say(room, "act", action=None)
    assert (view["done"], view["end"]["reached"]) == (True, False)
    assert say(room, "go on")["stage"] == "questions"


def test_several_take_part_at_once(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    with ThreadPoolExecutor(6) as pool:
        rooms = list(pool.map(lambda _: join(study), range(6)))
        list(pool.map(lambda room: finish(room, design), rooms))
    assert sorted(room.joined["place"] for room in rooms) == list(range(6))
    assert len({room.name for room in rooms}) == 6
    assert all(room.stage == "end" for room in rooms)


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


# -- restarts


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


def test_whatever_was_written_last_the_study_goes_on(folder: Path) -> None:
    """The machine fails after any line."""
    (folder / "study.toml").write_text(PLAIN[: PLAIN.rindex("[[scenarios]]")])
    room = join(opened(folder))
    finish(room, open_design(folder))
    whole = (folder / "P001.jsonl").read_text().splitlines(keepends=True)
    for count in range(1, len(whole)):
        if '"epoch"' in whole[count - 1] and count % 5:
            continue
        (folder / "P001.jsonl").write_text("".join(whole[:count]) + '{"event": "ep')
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


def test_a_study_that_was_begun_otherwise_is_refused(folder: Path) -> None:
    first = open_design(folder, seed=4)
    assert open_design(folder).mark == first.mark
    with pytest.raises(UsageError, match=r"--seed: the study in .* was begun with 4"):
        open_design(folder, seed=5)
    with pytest.raises(UsageError, match=r"--discount: the study in .* was begun with 3/5"):
        open_design(folder, discount="9/10")
    (folder / "study.toml").write_text(PLAIN.replace("good", "bad"))
    with pytest.raises(InputError, match="not what the study was begun with"):
        open_design(folder)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("consent = []", "consent: "),
        ('conditions = ["loud"]', "conditions: expected some of none, silent, announced"),
        ('[[questions]]\ntext = "a"\nkind = "choice"', "choices: go with kind = 'choice'"),
        ('[[questions]]\ntext = "a"\npoints = 100', "questions.0.points: "),
        ('[[scenarios]]\nname = "a"', "scenario a: expected an example, or files"),
        ('[[scenarios]]\nname = "a"\nexample = "x"', "scenario a: example: expected one of"),
        ('[[scenarios]]\nname = "a"\nfiles = ["x"]', "scenario a: "),
        ("speed = 3", "speed: extra inputs"),
    ],
)
def test_a_wrong_study_file_is_one_line(text: str, said: str, tmp_path: Path, capsys) -> None:
    (tmp_path / "study.toml").write_text(text)
    assert main(["play", "--quiet", "--study", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert "study.toml" in error


# -- what comes out


def test_only_who_has_the_secret_sees_and_saves(folder: Path) -> None:
    study, design = opened(folder), open_design(folder)
    join(study, address={"id": "<b>x</b>"})
    start = f"experimenter/{design.secret}/"
    for name in ("", "events.json", "events.csv", "rounds.csv", "codebook.csv"):
        assert study.file(start + name) is not None
        assert study.file(f"experimenter/{'x' * len(design.secret)}/{name}") is None
    assert study.file(start + "study.json") is None
    assert study.file("export.json") is None
    page = study.file(start)
    assert page is not None
    assert "&lt;b&gt;x" in page.text
    assert not any(f">{name}<" in page.text for name in CONDITIONS)


def test_the_table_of_rounds_is_read_back(folder: Path, capsys) -> None:
    study, design = opened(folder, seed=1), open_design(folder)
    for _ in range(4):
        finish(join(study), design)
    say(join(study), "go on")
    say(join(study), "withdraw")
    start = f"experimenter/{design.secret}/"
    table, book = study.file(start + "rounds.csv"), study.file(start + "codebook.csv")
    assert table is not None
    assert book is not None
    head = table.text.splitlines()[0].split(",")
    assert [line.split(",")[0] for line in book.text.splitlines()[1:]] == head
    (folder / "rounds.csv").write_text(table.text)
    rows = analysis.read_rounds(folder / "rounds.csv")
    assert Counter(row["condition"] for row in rows) == {"none": 4, "silent": 4}
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
