"""A process that is asked to end says so in one line and gives its best answer, at any moment and signal."""

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from serendipity.cli import entry
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.process.interrupts import cancelling
from serendipity.cli.process.signals import SIGNALS

WORKING = """
import sys
from dataclasses import replace
import serendipity
from serendipity.cli import entry

best = serendipity.plan(serendipity.example("room2"), discount=0.6)

def anytime(task, *, cancelled, **options):
    yield replace(best, status="feasible")
    assert cancelled.wait(60)
    yield replace(best, status="feasible")

serendipity.plan_anytime = anytime
sys.argv = "serendipity plan --example room2 --progress json -o answer.json".split()
entry.run()
"""

LOADING = """
import builtins, os, sys
from serendipity.cli import entry

real = builtins.__import__

def interrupted(name, *others):
    if name == "typer":
        os.kill(os.getpid(), int(sys.argv.pop()))
    return real(name, *others)

builtins.__import__ = interrupted
entry.run()
"""


SWALLOWED = """
import sys, time
from serendipity.cli import app, entry

def main():
    try:
        import interrupted
    except BaseException:  # as libraries do where a module is optional
        sys.exit("swallowed")
    time.sleep(60)

app.main = main
entry.run()
"""


@pytest.mark.parametrize("number", SIGNALS)
def test_a_signal_while_planning_writes_the_incumbent(number: signal.Signals, tmp_path: Path) -> None:
    running = subprocess.Popen(
        [sys.executable, "-c", WORKING], cwd=tmp_path, stderr=subprocess.PIPE, text=True, bufsize=1
    )
    while '"answer"' not in running.stderr.readline():
        assert running.poll() is None
    running.send_signal(number)
    _, told = running.communicate(timeout=60)
    assert running.returncode == ExitCode.INTERRUPTED
    assert told.splitlines()[-1] == "Interrupted."
    assert "Traceback" not in told
    assert json.loads((tmp_path / "answer.json").read_text())["cost"] == 12.6


@pytest.mark.parametrize("number", SIGNALS)
def test_a_signal_while_loading_is_one_line(number: signal.Signals) -> None:
    done = subprocess.run(
        [sys.executable, "-c", LOADING, str(int(number))], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (ExitCode.INTERRUPTED, "", "Interrupted.\n")


def test_no_library_takes_a_signal_for_a_missing_module(tmp_path: Path) -> None:
    (tmp_path / "interrupted.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n")
    program = [sys.executable, "-c", SWALLOWED]
    done = subprocess.run(program, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode != 0
    assert "swallowed" not in done.stderr
    assert "KeyboardInterrupt" in done.stderr


def test_the_first_signal_cancels_and_the_second_interrupts() -> None:
    with cancelling() as cancelled:
        signal.raise_signal(signal.SIGINT)
        assert cancelled.is_set()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_the_code_of_the_start_is_the_documented_one() -> None:
    assert entry.INTERRUPTED == ExitCode.INTERRUPTED
