"""What takes a while is shown on a terminal, told in lines elsewhere, and silent where it is unwanted."""

import io
import json
import os
import pty
import subprocess
import sys
import time
from contextvars import copy_context
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.streams import manner, progress, progress_bar, progress_lines
from tests.cli.conftest import Runs


class Screen(io.StringIO):
    """A terminal that keeps what it was told."""

    def isatty(self) -> bool:
        return True


def on_screen(monkeypatch: pytest.MonkeyPatch, patience: float = 0.05) -> Screen:
    """Put a screen where progress goes (in the test itself: pytest puts its own back before one)."""
    screen = Screen()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(progress_bar.Bar, "first", patience)
    monkeypatch.setenv("TERM", "xterm")
    return screen


def wait_for(screen: Screen, words: str) -> None:
    deadline = time.monotonic() + 20
    while words not in screen.getvalue():
        assert time.monotonic() < deadline, screen.getvalue()
        time.sleep(0.01)


def test_long_work_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)
    with progress.working("planning") as on_news:
        wait_for(screen, "planning")
        on_news("13, at least 12")
        wait_for(screen, "planning: 13, at least 12")


def test_counted_work_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)
    with progress.counting("searches") as on_progress:
        on_progress(3, 8)
        wait_for(screen, "3/8")


def test_short_work_leaves_no_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch, patience=60)
    with progress.working("planning"), progress.counting("calls") as on_progress:
        on_progress(1, 2)
    assert screen.getvalue() == ""


def test_nothing_is_shown_where_it_is_not_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)

    def work() -> None:
        manner.be_quiet(True)
        with progress.working("planning") as on_news:
            on_news("13")
            time.sleep(0.2)

    copy_context().run(work)
    assert screen.getvalue() == ""


def test_without_a_terminal_there_are_lines_that_get_rarer(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress_lines.PlainLines, "first", 0.02)
    with progress.counting("searches") as on_progress:
        on_progress(0, 8)
        on_progress(3, 8)
        time.sleep(0.3)  # lines after 0.02, 0.06, 0.14 and 0.3 seconds
    with progress.working("planning") as on_news:
        on_news("cost 13", cost=13.0)
        time.sleep(0.1)
    told = capsys.readouterr().err.splitlines()
    searches = [line for line in told if line == "searches: 3 of 8 (0 s, 0 s left)"]
    assert 1 <= len(searches) <= 4
    assert told.count("searches: done (0 s)") == 1
    assert "planning: cost 13 (0 s)" in told


def test_quick_work_says_nothing_without_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with progress.working("planning") as on_news:
        on_news("cost 13")
    assert capsys.readouterr().err == ""


def test_json_lines_hold_every_answer(run: Runs) -> None:
    done = run("plan --example room2 --discount 0.6 --progress json")
    assert done.code == 0
    events = [json.loads(line) for line in done.err.splitlines()]
    assert [event["event"] for event in events if event["what"] == "reading"] == ["done"]
    answers = [event for event in events if event["event"] == "answer"]
    assert answers[0]["cost"] == 13
    assert (answers[-1]["cost"], answers[-1]["objective"]) == (12.6, 1012.6)
    assert answers[-1]["lower_bound"] == answers[-1]["objective"]
    assert all(answer["what"] == "planning" and answer["seconds"] >= 0 for answer in answers)


def test_json_lines_count(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress_lines.JsonLines, "first", 0.01)
    done = run("interruptions --example room2 --progress json")
    events = [json.loads(line) for line in done.err.splitlines()]
    working = [event for event in events if event["what"] == "searches" and "done" in event]
    assert working
    assert all(0 < event["done"] <= event["total"] == 182 for event in working)


@pytest.mark.parametrize("words", ["", "--progress none", "--progress json --quiet"])
def test_progress_can_be_switched_off_and_its_style_holds_for_one_call_only(words: str, run: Runs) -> None:
    assert run("plan --example room2 --progress json").err
    assert run(f"plan --example room2 {words}").err == ""


def test_an_error_is_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)

    def interrupted() -> None:
        with progress.working("planning"):
            wait_for(screen, "planning")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    shown = screen.getvalue()
    time.sleep(0.3)
    assert screen.getvalue() == shown  # nothing draws any more


@pytest.mark.long
def test_ctrl_c_on_a_terminal_is_one_line(tmp_path: Path) -> None:
    """A report that takes long is interrupted while its bar is there."""
    serendipity.generate_usar(tmp_path / "building", rooms=60, medkits=4, robots=3, seed=1)
    command = "-m serendipity interruptions building --discount 0.9 --preservation state"
    ours, theirs = pty.openpty()
    running = subprocess.Popen(
        [sys.executable, *command.split()],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=theirs,
        env=os.environ | {"TERM": "xterm"},
    )
    os.close(theirs)
    shown = b""
    while b"searches" not in shown:
        shown += os.read(ours, 10_000)
    running.send_signal(2)
    out, _ = running.communicate(timeout=60)
    while True:
        try:
            shown += os.read(ours, 10_000)
        except OSError:  # the other end is closed, and all of it has been read
            break
    os.close(ours)
    assert running.returncode == ExitCode.INTERRUPTED
    assert out == b""
    assert b"Interrupted." in shown
    assert b"Traceback" not in shown
