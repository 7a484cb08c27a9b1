"""Nothing is done twice, nothing is lost, and no worker outlives a killed run."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from serendipity.evaluation.reproduction import Progress, Row, reproduce, run
from serendipity.model import InputError
from serendipity.model.resources.processes import in_processes

CALLS = {"modes": ["serendipity", "communication"], "discounts": ["0.6", "0.9"]}


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the tasks that are worked on, in order."""
    names: list[str] = []
    solve = run.solve

    def counted(assignment: run.Assignment) -> run.TaskRows:
        names.append(assignment.task.test)
        return solve(assignment)

    monkeypatch.setattr(run, "solve", counted)
    return names


def stop_after(tasks: int) -> Callable[[Progress], None]:
    def stop(progress: Progress) -> None:
        if progress.done == tasks:
            raise KeyboardInterrupt

    return stop


def test_an_interrupted_run_goes_on_where_it_was(suite: Path, tmp_path: Path, solved: list[str]) -> None:
    journal = tmp_path / "journal"
    with pytest.raises(KeyboardInterrupt):
        reproduce(suite, **CALLS, journal=journal, on_progress=stop_after(2))
    assert solved == ["1", "2"]
    first = reproduce(suite, **CALLS, journal=journal)
    assert solved == ["1", "2", "3", "4", "5", "6"]
    assert reproduce(suite, **CALLS, journal=journal) == first
    assert len(solved) == 6


def test_only_missing_calls_are_made(suite: Path, tmp_path: Path, solved: list[str]) -> None:
    journal = tmp_path / "journal"
    reproduce(suite, modes=["serendipity"], discounts=["0.6"], journal=journal)
    both = reproduce(suite, modes=["serendipity"], discounts=["0.6", "1/3"], journal=journal)
    assert len(both.rows) == 12
    assert len(solved) == 12
    reproduce(suite, modes=["serendipity"], discounts=["2/6", "0.60"], journal=journal)
    assert len(solved) == 12


def test_a_line_that_was_cut_off_is_done_again(suite: Path, tmp_path: Path, solved: list[str]) -> None:
    journal = tmp_path / "journal"
    first = reproduce(suite, **CALLS, journal=journal)
    whole = journal.read_bytes()
    journal.write_bytes(whole[:-10])
    again = reproduce(suite, **CALLS, journal=journal)
    assert solved[6:] == ["6"]
    assert list(map(timeless, again.rows)) == list(map(timeless, first.rows))
    assert reproduce(suite, **CALLS, journal=journal) == again


@pytest.mark.parametrize(
    "text",
    [
        *('{"schema": "serendipity.result/1", "status"', '{"a": 1}', "{}", "[", "{" * 99_999),
        *("a\nb", "no line break", '{"test": 1}\n'),
    ],
)
def test_what_is_no_journal_stays_as_it_is(text: str, suite: Path, tmp_path: Path) -> None:
    journal = tmp_path / "other.json"
    for content in (text, f"{text}\n"):
        journal.write_text(content)
        with pytest.raises(InputError, match="journal"):
            reproduce(suite, **CALLS, journal=journal)
        assert journal.read_text() == content


def test_a_task_that_changed_is_done_again(suite: Path, tmp_path: Path, solved: list[str]) -> None:
    copy, journal = tmp_path / "suite", tmp_path / "journal"
    shutil.copytree(suite, copy)
    reproduce(copy, **CALLS, journal=journal)
    shutil.rmtree(copy / "test2")
    shutil.copytree(suite / "test1", copy / "test2")
    changed = reproduce(copy, **CALLS, journal=journal)
    assert solved[6:] == ["2"]
    assert [row.cost for row in changed.rows if row.test == "2"] == [
        row.cost for row in changed.rows if row.test == "1"
    ]


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="needs /proc to find a process's children")
def test_kill_in_the_middle(suite: Path, tmp_path: Path) -> None:
    answer, journal = tmp_path / "rows.csv", tmp_path / "rows.csv.journal"
    modes = ["--modes", "serendipity,communication", "--discounts", "0.6,0.9"]
    command = [sys.executable, "-m", "serendipity", "reproduce", str(suite), *modes]
    running = subprocess.Popen([*command, "-o", str(answer), "--jobs", "2"])
    while running.poll() is None and not (journal.exists() and journal.read_bytes().endswith(b"\n")):
        time.sleep(0.005)
    children = Path(f"/proc/{running.pid}/task/{running.pid}/children").read_text().split()
    assert children
    running.send_signal(signal.SIGKILL)
    running.wait()
    kept = journal.read_bytes().rpartition(b"\n")[0].splitlines()
    assert kept
    assert not answer.exists()
    for child in children:
        ended(int(child))
    subprocess.run([*command, "-o", str(answer)], check=True)
    uninterrupted = reproduce(suite, **CALLS)
    found = [line.split(",") for line in answer.read_text().splitlines()[1:]]
    assert [[*cells[:7], *cells[8:]] for cells in found] == list(map(timeless, uninterrupted.rows))
    assert not journal.exists()


def test_workers_end_where_nobody_asks_for_more() -> None:
    started = time.monotonic()
    finished = in_processes(time.sleep, [0.0, 600.0], jobs=2)
    next(finished)
    finished.close()
    assert time.monotonic() - started < 60


def timeless(row: Row) -> list[str]:
    """The cells, without the seconds."""
    cells = row.cells()
    return [*cells[:7], *cells[8:]]


def ended(pid: int) -> None:
    """Wait until a process is gone, or fail."""
    for _ in range(1000):
        try:
            os.kill(pid, 0)
            if "\nState:\tZ" in Path(f"/proc/{pid}/status").read_text():
                return
        except (ProcessLookupError, FileNotFoundError):
            return
        time.sleep(0.01)
    pytest.fail(f"worker {pid} outlived the run")
