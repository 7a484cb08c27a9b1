"""What takes a while is shown on a terminal, told in a log, and silent where it is piped."""

import io
import logging
import os
import pty
import subprocess
import sys
import time
from pathlib import Path

import pytest

import serendipity
from serendipity.cli import progress
from serendipity.cli.exit_codes import ExitCode


class Screen(io.StringIO):
    """A terminal that keeps what it was told."""

    def isatty(self) -> bool:
        return True


def on_screen(monkeypatch: pytest.MonkeyPatch, patience: float = 0.05) -> Screen:
    """Put a screen where progress goes (in the test itself: pytest puts its own back before one)."""
    screen = Screen()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(progress, "_PATIENCE", patience)
    monkeypatch.setenv("TERM", "xterm")
    return screen


def wait_for(screen: Screen, words: str) -> None:
    deadline = time.monotonic() + 20
    while words not in screen.getvalue():
        assert time.monotonic() < deadline, screen.getvalue()
        time.sleep(0.01)


def test_long_work_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)
    with progress.working("planning", quiet=False) as on_news:
        wait_for(screen, "planning")
        on_news("13, at least 12")
        wait_for(screen, "planning: 13, at least 12")


def test_counted_work_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)
    with progress.counting("searches", quiet=False) as on_progress:
        on_progress(3, 8)
        wait_for(screen, "3/8")


def test_short_work_leaves_no_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch, patience=60)
    with progress.working("planning", quiet=False), progress.counting("calls", quiet=False) as on_progress:
        on_progress(1, 2)
    assert screen.getvalue() == ""


def test_nothing_is_shown_where_it_is_not_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)
    with progress.working("planning", quiet=True) as on_news:
        on_news("13")
        time.sleep(0.2)
    assert screen.getvalue() == ""


def test_a_log_has_plain_lines(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "_PATIENCE", 0.0)
    monkeypatch.setattr(logging.getLogger("serendipity"), "propagate", True)
    with caplog.at_level(logging.INFO, logger="serendipity.progress"):
        with progress.counting("searches", quiet=False) as on_progress:
            on_progress(3, 8)
        with progress.working("planning", quiet=False) as on_news:
            on_news("13")
    told = [record.getMessage() for record in caplog.records]
    assert "3 of 8 searches" in told
    assert any(line.startswith("planning: 13") for line in told)
    assert any(line.startswith("planning: done after") for line in told)


def test_an_error_is_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)

    def interrupted() -> None:
        with progress.working("planning", quiet=False):
            wait_for(screen, "planning")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    shown = screen.getvalue()
    time.sleep(0.3)
    assert screen.getvalue() == shown  # nothing draws any more


def test_ctrl_c_on_a_terminal_is_one_line(tmp_path: Path) -> None:
    """A report that takes long is interrupted while its bar is there."""
    serendipity.generate_usar(tmp_path / "building", rooms=30, medkits=3, robots=2, seed=1)
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
