"""Nothing is done twice, nothing is lost, and no worker outlives a killed run.

What is broken in a suite is a row of its own, with a reason; all else is answered.
"""

import asyncio
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from fractions import Fraction
from itertools import count
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.evaluation.reproduction import Progress, Row, reproduce, run, work
from serendipity.evaluation.reproduction.pool import _client, _done_in_time, on_dask
from serendipity.evaluation.reproduction.suite import TaskFolder
from serendipity.evaluation.reproduction.work import Assignment, Call, TaskRows
from serendipity.model import InputError, SerendipityError
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


SHORT: dict[str, Any] = {"modes": ["individual", "serendipity"], "discounts": ["0.6"]}


@pytest.mark.long
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_file_that_cannot_be_read(jobs: int, suite: Path, tmp_path: Path) -> None:
    shutil.copytree(suite, tmp_path / "suite")
    problem = tmp_path / "suite" / "test4" / "commx" / "problem.pddl"
    good, journal = problem.read_text(), tmp_path / "journal"
    problem.write_text("(define (problem")
    run = reproduce(tmp_path / "suite", **SHORT, jobs=jobs, journal=journal)
    assert [row.test for row in run.rows if row.status == "error"] == ["4", "4"]
    assert run.errors.keys() == {"4"}
    assert str(problem) in run.errors["4"]
    assert (run.complete, run.unproved) == (False, 0)
    assert sum(row.proved for row in run.rows) == 10
    problem.write_text(good)
    assert reproduce(tmp_path / "suite", **SHORT, jobs=jobs, journal=journal).complete


def test_a_fault_of_the_planner(suite: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def plan(task: serendipity.Task, **options: Any) -> serendipity.Result:
        if options["mode"] == "serendipity" and task.name in ("test2", "test5"):
            raise AssertionError("no such case")
        return serendipity.plan(task, **options)

    monkeypatch.setattr(work, "plan", plan)
    run = reproduce(suite, **SHORT)
    assert {(row.test, row.mode) for row in run.rows if row.status == "error"} == {
        ("2", "serendipity"),
        ("5", "serendipity"),
    }
    assert set(run.errors.values()) == {"unexpected AssertionError: no such case"}


def kill_once(place: str) -> str:
    """Be killed, unless that has happened before."""
    mark = Path(place)
    if mark.name.startswith("fatal") or (mark.name.startswith("first") and not mark.exists()):
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return mark.name


@pytest.mark.long
def test_a_killed_process_is_tried_again_alone(tmp_path: Path) -> None:
    def lost(place: str) -> str:
        return f"lost {Path(place).name}"

    for killer, outcome in (("first b", "first b"), ("fatal b", "lost fatal b")):
        places = [str(tmp_path / name) for name in ("a", killer, "c", "d")]
        assert sorted(in_processes(kill_once, places, 2, lost)) == sorted(["a", outcome, "c", "d"])
    with pytest.raises(SerendipityError, match="killed twice"):
        list(in_processes(kill_once, [str(tmp_path / "fatal")], 2))


def assignment(name: str) -> Assignment:
    return Assignment(TaskFolder(name, Path(name), ""), (Call("individual", Fraction(0)),))


def die(given: Assignment) -> TaskRows:
    if given.task.test == "fatal":
        os.kill(os.getpid(), signal.SIGKILL)
    return work.failed(given, "not asked")


def test_a_chunk_ends_after_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = count(0.0, 0.6)
    monkeypatch.setattr("serendipity.evaluation.reproduction.pool.perf_counter", lambda: next(clock))
    given = [*map(assignment, "abcd")]
    assert [rows.test for rows in _done_in_time(die, given)] == ["a", "b"]


@pytest.mark.long
def test_dask_keeps_neither_profiles_nor_messages() -> None:
    """Each second of a deep call makes profiles larger, each of the last 1,000 messages has a chunk in it."""
    pytest.importorskip("distributed", reason="needs the extra 'dask'")
    import dask

    with _client("local", 1) as client:
        assert set(client.run(dask.config.get, "distributed.worker.profile.enabled").values()) == {False}
        sent = [*client.cluster.scheduler.stream_comms.values(), client.scheduler_comm]
        assert [each.recent_message_log.maxlen for each in sent] == [10, 10]


@pytest.mark.long
def test_a_worker_is_started_again_however_long_that_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that took longer than 15 seconds, on a busy machine, was given up: the run waited for ever."""
    pytest.importorskip("distributed", reason="needs the extra 'dask'")
    import dask
    from distributed import KilledWorker
    from distributed.nanny import WorkerProcess

    start = WorkerProcess.start

    async def slowly(process: WorkerProcess) -> object:
        await asyncio.sleep(2)
        return await start(process)

    sooner = {"distributed.deploy.lost-worker-timeout": "1s", "distributed.scheduler.allowed-failures": 0}
    with dask.config.set(sooner), _client("local", 1) as client:
        monkeypatch.setattr(WorkerProcess, "start", slowly)
        with pytest.raises(KilledWorker):
            client.submit(os._exit, 1).result()
        assert client.submit(abs, -1).result(timeout=60) == 1


@pytest.mark.long
def test_a_task_that_kills_dasks_workers(caplog: pytest.LogCaptureFixture) -> None:
    pytest.importorskip("distributed", reason="needs the extra 'dask'")  # which has its defaults
    import dask

    with socket.socket() as taken, dask.config.set({"distributed.scheduler.allowed-failures": 0}):
        with suppress(OSError):  # as a second cluster on this machine finds it
            taken.bind(("127.0.0.1", 8787))
            taken.listen()
        given = [*map(assignment, ("a", "b", "c", "fatal", "d", "e"))]  # the third and fourth are one chunk
        found = [(rows.test, rows.rows[0].reason) for rows in on_dask(die, given, "local", 1)]
    assert sorted(found)[:-1] == [(name, "not asked") for name in "abcde"], "nobody twice, nobody blamed"
    assert "was killed" in str(dict(found)["fatal"])
    dasks = [record for record in caplog.records if record.name.startswith("distributed")]
    assert not [record for record in dasks if record.levelname in ("WARNING", "ERROR")]


@pytest.mark.long
def test_a_scheduler_that_is_gone_is_one_line(tmp_path: Path) -> None:
    pytest.importorskip("distributed", reason="needs the extra 'dask'")  # which has its defaults
    import dask

    file = tmp_path / "scheduler.json"
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard"]
    scheduler = subprocess.Popen([*command, "--scheduler-file", str(file)], stderr=subprocess.DEVNULL)
    try:
        while not (file.exists() and file.read_text().rstrip().endswith("}")):  # it is written bit by bit
            assert scheduler.poll() is None
            time.sleep(0.01)
        address = str(dask.config.yaml.safe_load(file.read_text())["address"])
        threading.Timer(1.0, scheduler.kill).start()
        with dask.config.set({"distributed.comm.timeouts.connect": "1s"}):
            finished = on_dask(die, [assignment("a")], address, 1)
            with pytest.raises(SerendipityError, match=r"no scheduler any more at .* run the same command"):
                next(finished)
    finally:
        scheduler.kill()
        scheduler.wait()
