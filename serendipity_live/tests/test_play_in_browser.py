"""Rounds that somebody plays on the page, in a real Chromium: by clicks, by keys, on a phone."""

import json
import shutil
import signal
from pathlib import Path
from typing import Any

import httpx
import pytest

from serendipity_live.tests.conftest import Opened
from serendipity_live.tests.play_tasks import DOMAIN, TAKE
from serendipity_live.tests.server import Server, serving

pytestmark = pytest.mark.browser

TO_ROOM1 = ("hall3", "hall2", "hall1", "room1")


def go(page: Any, *places: str) -> None:
    for place in places:
        page.click(f'.reach[data-place="{place}"]')
        page.wait_for_selector(f'.reach[data-place="{place}"]', state="detached")


def treat(page: Any) -> list[str]:
    """End the round in room1; what it came to."""
    choose(page, "give treatment")
    page.wait_for_selector("#finish")
    costs: list[str] = page.locator("#finish-costs td").all_inner_texts()
    return costs


def choose(page: Any, text: str) -> None:
    page.click(f'#can button:has-text("{text}")')


def fits(page: Any) -> bool:
    return bool(page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth"))


def verdicts(server: Server) -> list[str]:
    return [e["verdict"] for e in server.client.get("/export.json").json() if e["event"] == "epoch"]


def pddl(problem: Path) -> tuple[str, ...]:
    return (str(DOMAIN), str(problem), "--human", "commx", "--robot", "robot")


def test_the_papers_example_by_clicks(opened: Opened) -> None:
    with serving("--example", "room2", command="play") as server:
        page = opened(server)
        page.click("#think")
        go(page, "hall8", "hall7", "hall6", "hall5", "hall4")
        assert page.inner_text("#can .offer .word").split("\n")[-1] == TAKE
        assert page.inner_text("#thought .verdict") == "helps"
        choose(page, TAKE)
        page.wait_for_selector('#can button:has-text("take medkit mk2")', state="detached")
        go(page, *TO_ROOM1)
        costs = treat(page)
        assert page.inner_text("#finish-text") == "11 epochs. You paid 11 instead of 13."
        assert costs == ["11", "12.6", "13", "0.4"]
        assert "epoch 6: commx and robot: take medkit mk2 from the robot" in page.inner_text("#finish-help")
        page.click("#ask-why")
        page.wait_for_selector('#why:has-text("12.6")')
        events = server.client.get("/export.json").json()
        last = events[-1]
        assert (last["team_cost"], last["alone_cost"], last["human_cost"]) == (12.6, 13.0, 11.0)
        met = next(event for event in events if event.get("epoch") == 6)
        assert met["steps"] == ["commx+robot: hand_over robot commx mk2 hall4"]
        table = server.client.get("/export.csv").text.splitlines()
        assert len(table) == 1 + len(events)
        page.click("#again")
        page.wait_for_selector('#epoch:text-is("1")')


def test_who_uses_the_keyboard_stays_where_they_are_and_hears_what_happens(opened: Opened) -> None:
    with serving(command="play") as server:
        page = opened(server)
        page.wait_for_selector("#can button")
        page.focus('.reach[data-place="hall8"]')
        page.keyboard.press("Space")  # goes there, and does not wait
        page.wait_for_selector('#epoch:text-is("2")')
        assert page.evaluate("document.activeElement.classList.contains('reach')")
        assert "hall8" in page.inner_text("#told")
        page.wait_for_selector("body:not(.settling)")
        page.focus("#can li:last-child button")
        page.keyboard.press("Enter")
        page.wait_for_selector('#epoch:text-is("3")')
        assert page.evaluate("document.activeElement.closest('#can') !== null")
        assert page.inner_text("#told").startswith("Epoch 3. You: ")


def test_two_pages_a_reload_and_a_server_that_stops(opened: Opened) -> None:
    with serving(command="play") as server:
        one, two = opened(server), opened(server, 390, 844)
        go(one, "hall8")
        two.wait_for_selector('#epoch:text-is("2")')
        assert fits(two)
        stale = {"do": "act", "moment": "1.1", "action": "move commx room13 hall8"}
        two.evaluate(
            "m => new Promise(r => { const s = new WebSocket(`ws://${location.host}/live`);"
            "s.onopen = () => s.send(m); s.onmessage = () => setTimeout(() => { s.close(); r(); }, 200); })",
            json.dumps(stale),
        )
        go(two, "hall7")
        one.wait_for_selector('#epoch:text-is("3")')
        one.reload()
        one.wait_for_selector('#epoch:text-is("3")')
        assert one.locator("#log li").count() == 2
        saved = httpx.get(f"{server.url}/export.json").json()
        assert len([event for event in saved if event["event"] == "epoch"]) == 2
        assert server.stop(signal.SIGTERM)[0] == 130
        one.wait_for_selector("#lost")
        assert one.inner_text("#epoch") == "3"


def test_local_view_on_a_phone(opened: Opened) -> None:
    with serving("--view", "local", command="play") as server:
        page = opened(server, 390, 844)
        page.wait_for_selector("#can button")
        assert page.locator("#map .unseen").count() == 20
        assert page.locator("#map .remembered").count() == 3
        go(page, "hall8", "hall7", "hall6", "hall5")
        assert "robot" not in page.inner_text("#log")
        go(page, "hall4")
        assert "the robot: go to hall4" in page.inner_text("#log")
        assert page.locator("#map [data-token=agent-1].remembered").count() == 0
        assert fits(page)


def test_where_there_is_no_map_there_are_lists(opened: Opened, tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text(
        "(define (domain d) (:requirements :strips) (:predicates (open ?a) (done ?a) (is ?a))"
        "(:action open_it :parameters (?a) :precondition (is ?a) :effect (open ?a))"
        "(:action finish :parameters (?a) :precondition (open ?a) :effect (done ?a)))"
    )
    (tmp_path / "p.pddl").write_text(
        "(define (problem p) (:domain d) (:objects h r) (:init (is h) (is r)) (:goal (done h)))"
    )
    task = (str(tmp_path / "d.pddl"), str(tmp_path / "p.pddl"), "--human", "h", "--robot", "r")
    with serving(*task, command="play") as server:
        page = opened(server)
        page.wait_for_selector('#facts:has-text("Nothing")')
        choose(page, "open it")
        page.wait_for_selector('#facts:has-text("open h")')
        choose(page, "finish")
        page.wait_for_selector("#finish")


def test_a_double_click_is_one_choice(opened: Opened) -> None:
    """Also one that the browser takes for two clicks."""
    with serving(command="play") as server:
        page = opened(server)
        for count in (2, 3):
            page.wait_for_selector("body:not(.settling) #can button")  # there, and no longer new
            box = page.locator("#can button").first.bounding_box()
            for _ in range(3):
                page.mouse.click(box["x"] + 20, box["y"] + 10)
                page.wait_for_timeout(40)
            page.wait_for_selector(f'#epoch:text-is("{count}")')
            page.wait_for_timeout(300)
            assert page.inner_text("#epoch") == str(count)
        assert page.is_hidden("#refused")


def test_a_round_goes_on_when_the_server_is_back(opened: Opened, tmp_path: Path) -> None:
    with serving(command="play") as server:
        page = opened(server)
        go(page, "hall8", "hall7", "hall6")
        (record,) = (server.folder / "serendipity-play").glob("*.jsonl")
        shutil.copy(record, tmp_path / "record.jsonl")
        server.stop(signal.SIGTERM)
        page.wait_for_selector("#lost")
        port = str(server.port)
        with serving("--records", str(tmp_path / "record.jsonl"), "--port", port, command="play"):
            page.wait_for_selector("#lost", state="hidden")
            page.wait_for_selector('#epoch:text-is("4")')
            assert page.is_hidden("#anew")
            go(page, "hall5")
        page.wait_for_selector("#lost")
        with serving("--port", port, command="play"):
            page.wait_for_selector("#anew")
            assert page.inner_text("#epoch") == "1"
