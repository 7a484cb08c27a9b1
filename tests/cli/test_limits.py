"""Every command that works for long keeps its limits: with what it knows, or with one line.

A process that is asked to end says so in one line and gives its best answer, at any moment and signal.
"""

import ast
import json
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.cli import entry
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import limits, naming
from serendipity.cli.options.limits import during
from serendipity.cli.process.interrupts import cancelling
from serendipity.cli.process.signals import SIGNALS
from serendipity.model import Deadline, LimitReachedError
from tests.cli.conftest import Runs, assert_one_line
from tests.cli.test_exit_codes import anytime

ROOT = Path(__file__).parents[2]


GOALS = "3: conducted_triage commx room1\n1: conducted_triage commx hall1\n"

COMMANDS = (
    "plan --example room2 --discount 0.6 --format json",
    "plan --example room2 --discount 0.6 --verify --format json",
    "plan --example room2 --discount 0.6 --ties robust --format json",
    "plan --example room2 --discount 0.6 --human-model local --format json",
    "plan --example room2 --discount 0.6 --goals goals.txt --format json",
    "plan --example room2 --mode assistance --format json",
    "verify --example room2 answer.json --format json",
    "solve --example room2 --discount 0.6 --format json",
    "simulate --example room2 answer.json --format json",
    "explain --example room2 --discount 0.6 --format json",
    "explain --example room2 answer.json --format json",
    "interruptions --example room2 --discount 0.6 --format json",
    "recognise --example room2 --goals goals.txt --format json",
    "reproduce suite --modes serendipity --discounts 0.6 --format json",
)
"""All but `crosscheck`, which writes no JSON."""

NOTHING_KNOWN = 4


@pytest.fixture
def files(tmp_path: Path) -> None:
    """What the commands ask for."""
    answer = serendipity.plan(serendipity.example("room2"), discount="0.6")
    (tmp_path / "answer.json").write_text(json.dumps(answer.to_dict()))
    (tmp_path / "goals.txt").write_text(GOALS)
    serendipity.generate_usar(tmp_path / "suite" / "test1", preset="room2")


@pytest.mark.parametrize("limit", ["--time-limit 0", "--time-limit 0.05", "--memory-limit 1"])
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.usefixtures("files")
def test_a_limit_ends_a_command_in_good_order(command: str, limit: str, run: Runs) -> None:
    done = run(f"{command} {limit}")
    assert done.code in (0, 3, NOTHING_KNOWN), done
    assert done.err.count("\n") <= 1, done.err
    assert done.out or done.code == NOTHING_KNOWN
    if done.out:
        json.loads(done.out)
    if done.err:
        assert done.code == NOTHING_KNOWN
        assert f"; give more with {limit.split()[0]}" in done.err


@pytest.mark.parametrize("option", ["--time-limit", "--memory-limit"])
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.usefixtures("files")
def test_a_limit_that_is_none_is_told_before_the_work(command: str, option: str, run: Runs) -> None:
    name = option[2:].replace("-", "_")
    assert_one_line(run(f"{command} {option} soon"), f"{name}: expected", "'soon'")
    assert_one_line(run(f"{command} {option}=-1"), f"{name}: expected at least 0")


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("plan --example room2 --time-limit 0", r"The time limit came first, .*usar/domain\.pddl\)"),
        ("explain --example room2 --memory-limit 1", r"Memory is used up, reading the task.*"),
    ],
)
def test_no_time_or_memory_to_read_is_one_line_and_4(command: str, said: str, run: Runs) -> None:
    done = run(command)
    assert (done.code, done.out) == (4, "")
    assert re.fullmatch(f"{said}; give more with {command.split()[-2]}.*\n", done.err)


def test_memory_that_runs_out_anywhere_is_one_line_and_4(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    anytime(monkeypatch, MemoryError())
    done = run("plan --example room2")
    assert (done.code, done.out, done.err.count("\n")) == (4, "", 1)
    assert done.err.startswith("Memory is used up")


def test_one_deadline_covers_reading_planning_and_checking(
    run: Runs, monkeypatch: pytest.MonkeyPatch
) -> None:
    met: dict[str, float | None] = {}

    def noting(name: str, work: Callable[..., Any]) -> Callable[..., Any]:
        def noted(*arguments: Any, deadline: Deadline, **more: Any) -> Any:
            met[name] = deadline.left()
            return work(*arguments, deadline=deadline, **more)

        return noted

    load = noting("load", serendipity.example)
    monkeypatch.setattr(naming.TaskName, "load", lambda _, deadline, **__: load("room2", deadline=deadline))
    monkeypatch.setattr(serendipity, "plan_anytime", noting("plan", serendipity.plan_anytime))
    monkeypatch.setattr(serendipity, "check", noting("check", serendipity.check))
    assert run("plan --example room2 --discount 0.6 --time-limit 60 --memory-limit 99999").code == 0
    left = [met[name] for name in ("load", "plan", "check")]
    assert all(seconds is not None and 0 < seconds <= 60 for seconds in left)
    assert left[0] > left[2]  # type: ignore[operator]


def test_limits_are_among_the_options_of_a_result(run: Runs) -> None:
    done = run("plan --example room2 --time-limit 60 --memory-limit 99999 --format json")
    options = json.loads(done.out)["options"]
    assert (options["time_limit"], options["memory_limit"]) == (60, 99999)


@pytest.mark.usefixtures("files")
def test_rows_that_are_not_proved_are_told(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    done = run("reproduce suite --modes serendipity --discounts 0.6 --time-limit 0")
    assert done.code == NOTHING_KNOWN
    assert "1 of 1 rows are not proved: a limit came first" in done.out
    data = json.loads(
        run("reproduce suite --modes serendipity --discounts 0.6 --time-limit 0 --format json").out
    )
    assert (data["complete"], data["rows"][0]["status"]) == (False, "unknown")


def test_crosscheck_takes_limits_for_each_answer(run: Runs) -> None:
    done = run("crosscheck --count 2 --seed 1 --judges search,automata --time-limit 0 --memory-limit 99999")
    assert (done.code, done.out) == (0, "2 calls, search, automata: 0 disagreements\n")


def test_what_was_going_on_is_said_once() -> None:
    with pytest.raises(LimitReachedError, match=r"^the time limit came first, planning$"), during("reading"):
        raise LimitReachedError("time-limit", "planning")
    with pytest.raises(LimitReachedError, match=r"^memory is used up, reading$"), during("reading"):
        raise MemoryError


@pytest.mark.long
def test_what_is_loaded_in_the_middle_is_loaded_first_under_a_time_limit() -> None:
    """Loading arrays and solvers takes longer than a short limit allows to overrun it."""
    late = {name for room in ("search", "verify") for name in imported_in_functions(ROOT / room)}
    late = {name for name in late if "assistance" not in name}  # the mode's own modules are known beforehand
    modules = {"verify.certificate.certify", *limits.PLANNING, *limits.CHECKING}
    load = f"from serendipity.cli.options import limits; limits.load({sorted(modules)})"
    code = f"import sys; {load}; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    asked_for = {"pulp", "logging", "multiprocessing"}  # by who wants CBC, or has no kernel
    assert late - {*loaded.split()} <= asked_for


def imported_in_functions(room: Path) -> Iterator[str]:
    for file in room.rglob("*.py"):
        for function in ast.walk(ast.parse(file.read_text())):
            if isinstance(function, ast.FunctionDef):
                for node in ast.walk(function):
                    if isinstance(node, ast.Import):
                        yield from (alias.name for alias in node.names)
                    elif isinstance(node, ast.ImportFrom) and node.module:
                        yield node.module


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
