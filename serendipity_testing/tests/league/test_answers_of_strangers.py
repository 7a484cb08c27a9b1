"""Helpers of every kind: what they see, and what becomes of answers that are late, or none."""

import json
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any

import pytest

from serendipity.model import UsageError
from serendipity_testing.league import Score, season
from serendipity_testing.league.play import played
from serendipity_testing.league.protocol import AskedRobots, Helper
from serendipity_testing.tests.league.small import ALONE, DOOR, LEAST, at_the_door, does, dozes


def assert_waited(row: Score, *, bad: int = 0, late: int = 0) -> None:
    """Nothing was done for the person, and nothing against them."""
    assert (row.paid, row.decisions, row.bad, row.late) == (ALONE, 3, bad, late), row


@pytest.mark.parametrize(
    ("answer", "fault"),
    [
        ("unlock", "an answer: expected an object, got 'unlock'"),
        ({"action": {}}, "an answer: expected some of actions, human, got 'action'"),
        ({"actions": ["unlock robot"]}, "actions: expected an object, got ['unlock robot']"),
        ({"actions": {"ann": None}}, "actions: expected some of robot, got 'ann'"),
        ({"actions": {"robot": "fly robot"}}, "robot: expected a legal action or null, got 'fly robot'"),
        ({"actions": {"robot": 3}}, "robot: expected a legal action or null, got 3"),
        ({"human": {"plan 7": None}}, "human: expected some of plan 1, got 'plan 7'"),
        (
            {"human": {"plan 1": "bar robot"}},
            "human, plan 1: expected an action of theirs or null, got 'bar robot'",
        ),
    ],
)
def test_an_answer_that_is_none_is_waiting_and_counted(answer: Any, fault: str) -> None:
    row = at_the_door(lambda _: answer)
    assert_waited(row, bad=3)
    assert row.fault == fault


@pytest.mark.parametrize("error", [ValueError, SystemExit, KeyboardInterrupt])
def test_who_fails_has_no_answer(error: type[BaseException]) -> None:
    def fails(seen: dict[str, Any]) -> None:
        raise error("no\nidea")

    row = at_the_door(fails)
    assert_waited(row, bad=3)
    assert row.fault == f"{error.__name__}: no idea"


def test_late_answers_are_waiting_and_counted() -> None:
    assert_waited(at_the_door(dozes, deadline=0.02), late=3)


def test_what_is_late_is_not_taken_for_the_next_answer() -> None:
    """The first decision comes too late, and would be wrong in the second epoch."""

    def slow(seen: dict[str, Any]) -> Any:
        if seen["epoch"] == 1:
            time.sleep(0.15)
            return {"actions": {"robot": "bar robot"}}
        return None

    assert_waited(at_the_door(slow, deadline=0.1), late=1)


def test_helpers_see_all_but_what_only_the_person_knows() -> None:
    case = next(case for case in season("spring", ["buildings"], 3) if case.torn)
    seen: list[list[dict[str, Any]]] = []

    def robots(case: Any, _: float | None) -> AskedRobots:
        seen.append([])
        return AskedRobots(case, seen[-1].append)

    runs = list(played(case, Helper("eye", robots), None))
    assert len(seen) == len(runs) == len(case.scenarios)
    assert all(run[:2] == seen[0][:2] for run in seen)  # alike, until the person has done something
    last = seen[0][-1]
    assert json.loads(json.dumps(last)) == last
    assert last.keys() == {"schema", "case", "epoch", "seconds", "task", "plans", "state", "history", "legal"}
    assert [one["name"] for one in last["plans"]] == [one.name for one in case.scenarios]
    plan = case.scenarios[0].plan
    assert last["history"][0] == {"human": case.task.actions[plan[0]].name, "robots": []}
    assert seen[0][0]["epoch"] == 0 and seen[0][1]["epoch"] == 1


def program(path: Path, text: str) -> str:
    """A command line that runs a text as a helper."""
    file = path / "helper.py"
    file.write_text(f"import json, sys, time\nfor line in sys.stdin:\n    seen = json.loads(line)\n{text}\n")
    return f"command:{sys.executable} {file}"


ANSWERS = "    print(json.dumps({'actions': {'robot': 'unlock robot'}}), flush=True)"


def test_a_program_helps(tmp_path: Path) -> None:
    row = at_the_door(program(tmp_path, ANSWERS), deadline=5)
    assert (row.paid, row.bad, row.late) == (LEAST, 0, 0)


def test_a_program_that_ends_is_begun_again(tmp_path: Path) -> None:
    row = at_the_door(program(tmp_path, "    if seen['epoch'] == 1: sys.exit(3)\n" + ANSWERS), deadline=5)
    assert (row.decisions, row.bad, row.late) == (3, 1, 0)
    assert row.fault == "the program has ended, exit code 3"


def test_a_program_that_writes_no_json_has_no_answer(tmp_path: Path) -> None:
    row = at_the_door(program(tmp_path, "    print('hello', flush=True)"), deadline=5)
    assert_waited(row, bad=3)
    assert row.fault == "expected JSON, got 'hello'"


def test_a_program_that_hangs_is_late_and_ended(tmp_path: Path) -> None:
    text = "    time.sleep(0 if seen['epoch'] == 0 else 600)\n    print('null', flush=True)"
    begun = time.monotonic()
    assert_waited(at_the_door(program(tmp_path, text), deadline=0.05), late=3)
    assert time.monotonic() - begun < 60


@contextmanager
def server(answer: Any, seconds: float = 0) -> Iterator[str]:
    """The address of an endpoint."""
    hold = threading.Event()

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            seen = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            hold.wait(seconds if seen["epoch"] else 0)
            try:
                self.send_response(200)
                self.end_headers()
                self.wfile.write(json.dumps(answer).encode())
            except OSError:
                pass  # nobody waits any more

        def log_message(self, *_: Any) -> None:
            pass

    with HTTPServer(("127.0.0.1", 0), Handler) as http:
        thread = threading.Thread(target=http.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        try:
            yield f"http://127.0.0.1:{http.server_port}/"
        finally:
            hold.set()
            http.shutdown()
            thread.join()


def test_an_endpoint_helps() -> None:
    with server({"actions": {"robot": "unlock robot"}}) as address:
        row = at_the_door(address, deadline=5)
    assert (row.paid, row.bad, row.late) == (LEAST, 0, 0)


def test_an_endpoint_that_hangs_is_late() -> None:
    with server(None, seconds=60) as address:
        row = at_the_door(address, deadline=0.05)
    assert_waited(row, late=3)


def test_an_endpoint_that_is_not_there_has_no_answer() -> None:
    row = at_the_door("http://127.0.0.1:9/", deadline=5)
    assert row.bad == 3 and row.fault is not None and row.fault.startswith("http://127.0.0.1:9/: ")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("ours-best", "helper: expected idle, random, greedy, ours:0.01,"),
        ("command:", "helper: expected idle"),
        ("command:no-such-program", "helper: there is no program 'no-such-program'"),
        ("python:json", "helper: expected 'package.module:function', got 'json'"),
        ("python:json:lods", "helper 'json:lods': module 'json' has no attribute 'lods'"),
        ("http://", "helper: expected idle"),
        ("http://[", "helper: expected idle"),
        ("ours:inf", "helper ours: expected seconds, got inf"),
        ("ours:soon", "helper ours: expected seconds"),
    ],
)
def test_a_helper_that_there_is_not_is_named_in_a_line(name: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        at_the_door(name)


def test_functions_are_found_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "my_helper.py").write_text("def help(seen): return {'actions': {'robot': 'unlock robot'}}\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert at_the_door("python:my_helper:help").paid == at_the_door(does("unlock robot")).paid == LEAST
    assert DOOR.name == "door"
