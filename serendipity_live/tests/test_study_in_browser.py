"""A study as its participants and whoever runs it see it, in a real Chromium."""

import csv
import io
import json
import re
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any

import networkx as nx
import pytest

from serendipity.scenarios.generate import make_usar
from serendipity.scenarios.usar import figure2
from serendipity_live.study import analysis
from serendipity_live.study.design import Design, open_design
from serendipity_live.tests.conftest import Opened
from serendipity_live.tests.server import Server, serving

pytestmark = pytest.mark.browser

BUILDING = nx.Graph(figure2().connections)


class Runner:
    """Whoever runs the study: its folder, and what their page has."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.design: Design = open_design(folder, rounds=1, seed=1)
        self.practice: int = json.loads((folder / "study.json").read_text())["practice"]

    def save(self, server: Server, name: str) -> str:
        return server.client.get(f"/experimenter/{self.design.secret}/{name}").text

    def number(self, server: Server, page: Any) -> int:
        who, place = page.inner_text("#participant").split(", ")
        if place == "practice":
            return self.practice
        events = json.loads(self.save(server, "events.json"))
        names = [e["scenario"] for e in events if e["participant"] == who and e["event"] == "begun"]
        return int(names[-1].rpartition("-")[2])


def press(page: Any, text: str) -> None:
    """Choose from the list, by its key."""
    epoch = page.inner_text("#epoch")
    texts = page.locator("#can .word").all_inner_texts()
    page.keyboard.press(str([told.endswith(text) for told in texts].index(True) + 1))
    page.wait_for_function(
        "epoch => document.getElementById('epoch').textContent !== epoch"
        " || !document.getElementById('finish').hidden",
        arg=epoch,
    )


def plays_well(page: Any, number: int) -> Iterator[None]:
    """Does what a robot asks for, takes what it offers, and else goes the shortest way, epoch by epoch."""
    task = make_usar(preset="figure2", medkits=4, seed=number)
    start, goal = task.agents_at[0], task.triage_in
    kits = {where: kit for kit, where in task.medkits.items()}
    nearest = min(kits, key=lambda kit: far(start, kit) + far(kit, goal))
    while page.is_hidden("#finish"):
        place = page.get_attribute("#map .here", "data-place")
        has = page.locator('#can .word:has-text("put down")').count() > 0
        asked = re.search(r"Please (.*) now", page.text_content("#said-text"))
        offers = page.locator("#can .offer .word").all_inner_texts()
        if offers or asked is not None:
            choice = offers[0].rpartition("\n")[2] if offers else asked[1]
        elif place == (goal if has else nearest):
            choice = f"give treatment in {goal}" if has else f"pick up medkit {kits[place]}"
        else:
            choice = f"go to {nx.shortest_path(BUILDING, place, goal if has else nearest)[1]}"
        press(page, choice)
        yield


def far(one: str, other: str) -> int:
    return int(nx.shortest_path_length(BUILDING, one, other))


def takes_part(
    page: Any, server: Server, runner: Runner, thinks: Callable[[Any], int] = lambda _: 5
) -> Iterator[None]:
    """From wherever they are to the end; ``thinks`` says what they answer on scales."""
    while page.is_hidden("#end"):
        if page.is_visible("#consent"):
            page.check("#agree")
            page.dblclick("#start")
            page.wait_for_selector("#instructions", state="visible")
        elif page.is_visible("#instructions"):
            page.dblclick("#understood")
            page.wait_for_selector("#play", state="visible")
        elif page.is_visible("#go-on"):
            practice = "practice" in page.inner_text("#participant")
            page.dblclick("#go-on")
            page.wait_for_selector("#finish" if practice else "#play", state="hidden")
        elif page.is_visible("#play"):
            yield from plays_well(page, runner.number(server, page))
        else:
            for question in page.locator("#asked fieldset").all()[:-1]:
                question.locator(f'label:has-text("{thinks(page)}")').click()
            page.fill("#asked textarea", "=1+1\n😀")
            page.click("#send")
            page.wait_for_selector("#end", state="visible")
        yield


def together(people: list[Iterator[None]]) -> None:
    """All at once, each doing one thing in turn."""
    while people:
        people = [person for person in people if next(person, ...) is None]


def test_twelve_take_part_of_whom_two_leave_and_one_comes_back(opened: Opened, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('completion_link = "https://example.org/?cc={code}&who={id}"\n')
    runner = Runner(tmp_path)
    arguments = ("--study", str(tmp_path))
    with serving(*arguments, command="play") as server:
        first = [opened(server, at=f"/?PROLIFIC_PID=p{i}") for i in range(4)]
        for page in first:
            person = takes_part(page, server, runner)
            for _ in range(5):
                next(person)
        assert len({page.inner_text("#participant") for page in first}) == 4
        first[0].on("dialog", lambda dialog: dialog.accept())
        first[0].click("#withdraw")
        first[0].wait_for_selector("#withdrawn", state="visible")
        link = first[1].url
        left = first[1].inner_text("#epoch")
        first[1].close()
        together([takes_part(page, server, runner) for page in first[2:]])
        code = first[2].inner_text("#code")
        port = str(server.port)
    with serving(*arguments, "--port", port, command="play") as server:  # it was stopped in between
        back = opened(server, at=link.removeprefix(server.url))
        back.wait_for_selector(f'#epoch:text-is("{left}")')
        for start in (0, 4):
            pages = [opened(server) for _ in range(4)]
            people = [back] if start == 0 else []
            together([takes_part(page, server, runner) for page in (*people, *pages)])
        assert back.inner_text("#code") == code == runner.design.code
        assert back.get_attribute("#completion-link", "href") == f"https://example.org/?cc={code}&who=p1"
        assert server.client.get("/s/nobody").status_code == 404
        overview = opened(server, at=f"/experimenter/{runner.design.secret}/")
        states = Counter(overview.locator("td:nth-child(3)").all_inner_texts())
        assert states == {"finished": 11, "withdrawn": 1}
        assert server.client.get("/experimenter/x/rounds.csv").status_code == 404
        events = json.loads(runner.save(server, "events.json"))
        rows = list(csv.DictReader(io.StringIO(runner.save(server, "rounds.csv"))))
        (tmp_path / "rounds.csv").write_text(runner.save(server, "rounds.csv"))
    judge(tmp_path, runner, events, rows)


def judge(folder: Path, runner: Runner, events: list[dict[str, Any]], rows: list[dict[str, str]]) -> None:
    """What was exported is whole, balanced, and says what the rehearsal had said."""
    written = [json.loads(line) for file in folder.glob("P*.jsonl") for line in file.read_text().splitlines()]
    assert sorted(map(str, events)) == sorted(map(str, written))
    joined = [event for event in events if event["event"] == "joined"]
    assert [event["participant"] for event in joined] == [f"P{i:03}" for i in range(1, 13)]
    assert {event["outside_id"] for event in joined[:4]} == {f"p{i}" for i in range(4)}
    assert all("Chrome" in event["browser"] and event["screen"] for event in joined)
    done = [row for row in rows if row["round"] == "1" and row["complete"] == "true"]
    assert len(done) == 11
    spread = Counter(row["condition"] for row in done)
    assert set(spread.values()) <= {3, 4}, "the place of the one who withdrew was given to another one"
    assert {row["answer_1"] for row in done} == {"5"}
    assert {row["answer_5"] for row in done} == {"'=1+1\n😀"}
    spared = analysis.by_person(analysis.read_rounds(folder / "rounds.csv"), "spared")
    assert {name: set(values) for name, values in spared.items()} == {
        "none": {0.0},
        "silent": {2.0},
        "announced": {4.0},
    }
    told = [event for event in events if event["event"] == "epoch" and event["condition"] == "announced"]
    assert any(event["said"] and event["said"].startswith("I will ") for event in told)
    assert all(event["page_seconds"] > 0 for event in told)
    assert analysis.main([str(folder / "rounds.csv")]) == 0


def test_the_page_speaks_the_language_of_the_study(opened: Opened, tmp_path: Path) -> None:
    arguments = ("--study", str(tmp_path), "--rounds", "1", "--seed", "1", "--language", "de")
    with serving(*arguments, command="play") as server:
        page = opened(server)
        page.check("#agree")
        page.click('button:text-is("Beginnen")')
        page.click('button:text-is("Ich habe das gelesen")')
        page.wait_for_selector("#play", state="visible")
        assert page.inner_text("#do-title") == "Sie können"
        assert page.locator("#can .word").last.inner_text() == "warten"
        assert "Übung" in page.inner_text("#participant")


LIKED = {"none": 2.5, "silent": 4.0, "announced": 5.5}
"""What fifty participants are made to think of the robot in the mean, by condition."""


@pytest.mark.slow
def test_fifty_take_part_and_what_they_were_made_to_think_is_found(opened: Opened, tmp_path: Path) -> None:
    """Two are interrupted, with the server, and go on; the analysis finds what was put in."""
    runner, dice, arguments = Runner(tmp_path), Random(1), ("--study", str(tmp_path))

    def conditions(server: Server) -> dict[str, str]:
        joined = (e for e in json.loads(runner.save(server, "events.json")) if e["event"] == "joined")
        return {event["participant"]: event["condition"] for event in joined}

    def take_part(server: Server, pages: list[Any]) -> None:
        def thinks(page: Any) -> int:
            condition = conditions(server)[page.inner_text("#participant").split(",")[0]]
            return min(7, max(1, round(dice.gauss(LIKED[condition], 1))))

        together([takes_part(page, server, runner, thinks) for page in pages])
        for page in pages:
            page.close()

    with serving(*arguments, command="play") as server:
        begun = [opened(server, at=f"/?participant=s{i}") for i in range(2)]
        for page in begun:
            person = takes_part(page, server, runner)
            for _ in range(5):
                next(person)
        links = [page.url.removeprefix(server.url) for page in begun]
        for page in begun:
            page.close()
        port = str(server.port)
    with serving(*arguments, "--port", port, command="play", seconds=600) as server:
        take_part(server, [opened(server, at=link) for link in links])
        for _ in range(12):
            take_part(server, [opened(server) for _ in range(4)])
        table = runner.save(server, "rounds.csv")
        spread = Counter(conditions(server).values())
    assert sorted(spread.values()) == [16, 17, 17]
    (tmp_path / "rounds.csv").write_text(table)
    rows = analysis.read_rounds(tmp_path / "rounds.csv")
    assert len({row["participant"] for row in rows}) == 50
    for measure in ("answer_1", "answer_2", "answer_3", "answer_4"):
        found = {name: analysis.estimate(told) for name, told in analysis.by_person(rows, measure).items()}
        for name, mean in LIKED.items():
            assert abs(found[name].mean - mean) < 2 * (found[name].half_width or 0)
    told = analysis.by_person(rows, "answer_2")
    more = analysis.difference(told["announced"], told["none"])
    assert more.mean > 2 and more.mean - (more.half_width or 0) > 1
