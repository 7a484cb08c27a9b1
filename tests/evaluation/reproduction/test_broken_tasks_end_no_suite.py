"""What is broken in a suite is a row of its own, with a reason; all else is answered."""

import asyncio
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress
from fractions import Fraction
from itertools import count
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.evaluation.reproduction import reproduce, work
from serendipity.evaluation.reproduction.pool import _client, _done_in_time, on_dask
from serendipity.evaluation.reproduction.suite import TaskFolder
from serendipity.evaluation.reproduction.work import Assignment, Call, TaskRows
from serendipity.model import SerendipityError
from serendipity.model.resources.processes import in_processes

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
