"""Killed workers, clients that vanish, stall or crowd in: the next request is answered."""

import json
import os
import signal
import socket
from pathlib import Path

import pytest
from starlette.exceptions import HTTPException

from serendipity.live.service.sessions import SessionStore
from tests.live.server import Server, serving, until, workers_of

ROOM2 = {"example": "room2"}
KEY = {"Idempotency-Key": "busy"}
ASKED = {"task": ROOM2, "options": {"discount": 0.6}}


def answers(server: Server) -> bool:
    return bool(server.post("/plan", ASKED).json()["cost"] == 12.6)


def figure(server: Server, name: str) -> float:
    lines = server.client.get("/metrics").text.splitlines()
    return sum(float(line.split()[-1]) for line in lines if line.startswith(name))


def test_killed_workers_are_replaced_and_nobody_notices(server: Server) -> None:
    session = server.post("/sessions", ASKED).json()
    path = f"/sessions/{session['id']}"
    before = server.post(f"{path}/plan", {}).json()
    killed = workers_of(server.process.pid)
    for pid in killed:
        os.kill(pid, signal.SIGKILL)
    assert answers(server)
    after = server.post(f"{path}/plan", {}).json()
    assert before["plan"] == after["plan"]
    until(lambda: len(workers_of(server.process.pid)) == 2)
    assert not set(killed) & set(workers_of(server.process.pid))
    assert figure(server, "serendipity_workers_replaced_total") >= 2


def test_figures_stay_few_whatever_is_asked(server: Server) -> None:
    for number in range(5):
        server.client.request(f"ODD{number}", f"/nowhere/{number}")
    text = server.client.get("/metrics").text
    assert "ODD" not in text
    assert "nowhere" not in text
    assert 'serendipity_requests_total{method="other",path="other",status="404"}' in text


def begin(server: Server, path: str, body: object) -> socket.socket:
    """A request whose answer nobody has taken yet."""
    content = json.dumps(body).encode()
    head = f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
    connection = socket.create_connection(("127.0.0.1", server.port))
    connection.sendall(f"{head}{len(content)}\r\n\r\n".encode() + content)
    return connection


@pytest.mark.parametrize("path", ["/plan", "/plan/anytime"])
def test_nobody_works_for_clients_that_have_gone(
    server: Server, long_call: dict[str, object], path: str
) -> None:
    connections = [begin(server, path, long_call) for _ in range(4)]
    until(lambda: server.busy == 2)
    for connection in connections:
        connection.close()
    until(lambda: server.busy == 0, seconds=5)
    assert answers(server)


def test_the_queue_has_an_end(server: Server, long_call: dict[str, object]) -> None:
    connections = [begin(server, "/plan", long_call) for _ in range(10)]  # two at work, eight in the queue
    until(lambda: server.client.get("/health").json()["waiting"] == 8)
    refused = server.post("/plan", ASKED)
    assert refused.status_code == 429
    assert refused.headers["retry-after"] == "1"
    assert refused.json()["error"].startswith("all workers are busy")
    for connection in connections:
        connection.close()
    until(lambda: server.busy == 0, seconds=10)
    assert answers(server)


def test_the_time_limit_ends_with_the_best_known(server: Server, long_call: dict[str, object]) -> None:
    options = {**long_call["options"], "time_limit": 0.5}
    answer = server.post("/plan", {**long_call, "options": options}).json()
    assert answer["status"] == "feasible"
    assert answer["lower_bound"] < answer["objective"]


def test_answers_come_on_the_way(server: Server, long_call: dict[str, object]) -> None:
    with server.client.stream("POST", "/plan/anytime", json=long_call) as response:
        first = next(line for line in response.iter_lines() if line.startswith("data: "))
        assert json.loads(first.removeprefix("data: "))["status"] == "feasible"
        assert server.busy == 1
    until(lambda: server.busy == 0, seconds=5)


def test_one_call_of_a_session_at_a_time(server: Server, long_call: dict[str, object]) -> None:
    session = server.post("/sessions", long_call).json()
    connection = begin(server, f"/sessions/{session['id']}/plan", {})
    until(lambda: server.busy == 1)
    step = (f"/sessions/{session['id']}/execute", {"actions": []})
    assert server.post(*step).status_code == 409
    assert server.post(*step, headers=KEY).status_code == 409
    connection.close()
    until(lambda: server.busy == 0, seconds=5)
    assert server.post(*step).status_code == 200
    assert server.post(*step, headers=KEY).status_code == 200  # that another one is under way is not kept


@pytest.mark.long
def test_workers_end_with_a_server_that_is_killed() -> None:
    with serving("--workers", "2") as server:
        assert answers(server)
        workers = workers_of(server.process.pid)
        server.process.kill()
        until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in workers))


@pytest.mark.long
def test_what_workers_have_in_temporary_files_goes_with_them(tmp_path: Path) -> None:
    def folders() -> list[Path]:
        return [*tmp_path.iterdir()]

    with serving("--workers", "2", env={"TMPDIR": str(tmp_path)}) as server:
        assert answers(server)
        before = folders()
        assert len(before) == 2
        for folder in before:
            (folder / "half-read.pddl").write_text("(define")
        for pid in workers_of(server.process.pid):
            os.kill(pid, signal.SIGKILL)
        until(lambda: len(folders()) == 2 and not {*before} & {*folders()})
        server.stop()
        until(lambda: not folders())
    with serving("--workers", "1", env={"TMPDIR": str(tmp_path)}) as server:
        server.process.kill()
        until(lambda: not folders())


def test_sessions_have_a_share_of_memory() -> None:
    sessions = SessionStore(1000, 3 * 2**20, 3600)
    begun = {"task": {"domain": "\N{ROBOT FACE}" * 2**18}}  # four bytes each
    for _ in range(2):
        sessions.add(sessions.begin(begun))
    assert sessions.size > 2 * 2**20
    with pytest.raises(HTTPException, match="all of them may take 3 MiB"):
        sessions.begin(begun)
    small = sessions.begin({"task": ROOM2})
    small.move(b" " * 2**20)
    with pytest.raises(HTTPException, match="all of them may take 3 MiB"):
        sessions.add(small)


def test_each_request_has_a_line_of_log(tmp_path: Path) -> None:
    with serving("--workers", "1", "-v") as server:
        answer = server.client.get("/health")
        server.client.get("/nowhere%0a")
        _, said = server.stop()
    lines = [line for line in said.splitlines() if "guards.responses" in line]
    assert len(lines) == 2
    assert "127.0.0.1 'GET /health' 200" in lines[0]
    assert lines[0].endswith(answer.headers["x-request-id"])
    assert "404" in lines[1]


@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)])
def test_a_signal_ends_it(number: int, long_call: dict[str, object]) -> None:
    with serving("--workers", "1", "--drain", "0") as server, begin(server, "/plan", long_call):
        until(lambda: server.busy == 1)
        workers = workers_of(server.process.pid)
        assert server.stop(number) == (130, "Interrupted.\n")
        until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in workers))


@pytest.mark.slow
def test_memory_has_a_limit(long_call: dict[str, object]) -> None:
    with serving("--workers", "1", "--memory-limit", "30") as server:
        answer = server.post("/plan", long_call)
        assert answer.status_code == 507
        assert answer.json()["error"].startswith("memory is used up")
        assert server.client.get("/health").status_code == 200
