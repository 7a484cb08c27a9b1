"""Killed workers, clients that vanish, stall or crowd in: the next request is answered.

Of servers side by side, whoever ends hands on, and whoever asks again is answered once.
"""

import asyncio
import json
import os
import signal
import socket
import time
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx
import pytest
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse

from serendipity_live.service.repeats import Repeats
from serendipity_live.service.sessions import SessionStore
from serendipity_live.tests.server import Server, serving, until, workers_of

ROOM2 = {"example": "room2"}
BUSY = {"Idempotency-Key": "busy"}
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
    assert server.post(*step, headers=BUSY).status_code == 409
    connection.close()
    until(lambda: server.busy == 0, seconds=5)
    assert server.post(*step).status_code == 200
    assert server.post(*step, headers=BUSY).status_code == 200  # that another one is under way is not kept


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


KEY = {"Idempotency-Key": "once"}


@pytest.fixture
def some_seconds(long_call: dict[str, Any]) -> dict[str, Any]:
    """A call that takes two of them."""
    return {**long_call, "options": {**long_call["options"], "time_limit": 2}}


def keep_busy(server: Server, call: dict[str, Any], others: ThreadPoolExecutor) -> Future[httpx.Response]:
    """Somebody else asks, and the only worker has begun."""
    answer = others.submit(httpx.post, f"{server.url}/plan", json=call, timeout=30)
    until(lambda: server.busy == 1)
    return answer


@pytest.mark.long
def test_who_drains_answers_what_it_has_begun_and_takes_nothing_new(some_seconds: dict[str, Any]) -> None:
    with serving("--workers", "1") as server, ThreadPoolExecutor() as others:
        assert server.client.get("/ready").json() == {"status": "ready"}
        answer = keep_busy(server, some_seconds, others)
        server.process.send_signal(signal.SIGTERM)
        until(lambda: server.client.get("/ready").status_code == 503)
        refused = server.post("/plan", ASKED)
        assert (refused.status_code, refused.headers["retry-after"]) == (503, "1")
        assert answer.result().json()["status"] in ("optimal", "feasible", "unknown")
        assert server.process.wait(timeout=20) == 0


@pytest.mark.long
def test_draining_has_an_end(some_seconds: dict[str, Any]) -> None:
    with serving("--workers", "1", "--drain", "0.2") as server, ThreadPoolExecutor() as others:
        keep_busy(server, some_seconds, others)
        begun = time.monotonic()
        assert server.stop(signal.SIGTERM)[0] == 0
        assert time.monotonic() - begun < 3


def test_what_is_sent_again_is_answered_once(server: Server) -> None:
    first = server.post("/plan", ASKED, headers=KEY)
    again = server.post("/plan", ASKED, headers=KEY)
    assert first.status_code == 200
    assert "idempotency-replayed" not in first.headers
    assert again.headers["idempotency-replayed"] == "true"
    assert again.content == first.content  # with the seconds that it took
    for path, body in (("/plan", {**ASKED, "options": {"discount": 0.7}}), ("/verify", ASKED)):
        other = server.post(path, body, headers=KEY)
        assert (other.status_code, other.json()["error"][:16]) == (422, "Idempotency-Key:")
    assert server.post("/plan", ASKED, headers={"Idempotency-Key": "x" * 201}).status_code == 422


@pytest.mark.parametrize(
    ("most", "size", "seconds", "keys", "worked"),
    [
        (3, 100, 60, "abcabc", "abc"),
        (3, 100, 60, "abcdbcda", "abcda"),  # who asks for the fourth sends the first away
        (3, 100, 60, "abcadab", "abcdb"),  # who was asked for again stays
        (9, 2, 60, "abcda", "abcda"),
        (9, 100, 0, "aab", "aab"),
    ],
)
def test_answers_are_kept_while_there_is_room(
    most: int, size: int, seconds: float, keys: str, worked: str
) -> None:
    seen = []

    async def noted(scope: Any, receive: Any, send: Any) -> None:
        seen.append((await receive())["body"].decode())
        await PlainTextResponse("x")(scope, receive, send)

    async def asked() -> None:
        repeats = httpx.ASGITransport(Repeats(noted, most, size, seconds))
        async with httpx.AsyncClient(transport=repeats, base_url="http://server") as client:
            for key in keys:
                await client.post("/", content=key, headers={"Idempotency-Key": key})

    asyncio.run(asked())
    assert "".join(seen) == worked


def test_a_step_is_taken_once_however_often_it_is_sent(server: Server) -> None:
    path = "/sessions/" + server.post("/sessions", ASKED).json()["id"]
    step, key = {"actions": ["move commx room13 hall8"]}, {"Idempotency-Key": "a"}
    with ThreadPoolExecutor() as others:
        sent = [
            others.submit(httpx.post, f"{server.url}{path}/execute", json=step, headers=key) for _ in range(5)
        ]
    assert {answer.result().status_code for answer in sent} == {200}
    assert len({tuple(answer.result().json()["facts"]) for answer in sent}) == 1
    assert server.post(f"{path}/execute", step).status_code == 422  # they are there already


@pytest.mark.long
def test_a_request_with_a_key_is_finished_though_nobody_waits(some_seconds: dict[str, Any]) -> None:
    with serving("--workers", "1") as server:
        with pytest.raises(httpx.ReadTimeout):
            httpx.post(f"{server.url}/plan", json=some_seconds, headers=KEY, timeout=0.5)
        assert server.busy == 1
        answer = server.post("/plan", some_seconds, headers=KEY)
        assert answer.headers["idempotency-replayed"] == "true"
        assert answer.status_code in (200, 504)


@pytest.mark.long
def test_what_says_try_again_is_not_kept(some_seconds: dict[str, Any]) -> None:
    with serving("--workers", "1", "--queue", "0") as server, ThreadPoolExecutor() as others:
        keep_busy(server, some_seconds, others)
        assert server.post("/plan", ASKED, headers=KEY).status_code == 429
        until(lambda: server.busy == 0)
        answer = server.post("/plan", ASKED, headers=KEY)
        assert answer.status_code == 200
        assert "idempotency-replayed" not in answer.headers


@pytest.mark.long
def test_a_session_goes_on_at_another_server() -> None:
    with serving("--workers", "1") as one, serving("--workers", "1") as other:
        path = "/sessions/" + one.post("/sessions", ASKED).json()["id"]
        plan = one.post(f"{path}/plan", {}).json()["plan"]
        now = [step["action"] for step in plan if step["epoch"] == 1]
        moved = one.post(f"{path}/execute?snapshot=true", {"actions": now}).json()
        snapshot = moved.pop("snapshot")
        assert snapshot == one.client.get(f"{path}/snapshot").json()
        assert moved == one.client.get(path).json()
        expected = one.post(f"{path}/plan", {}).json()
        one.process.kill()
        begun = other.post("/sessions", {"snapshot": snapshot})
        assert begun.status_code == 201
        there = f"/sessions/{begun.json()['id']}"
        found = other.post(f"{there}/plan", {}).json()
        assert (found["plan"], found["cost"]) == (expected["plan"], expected["cost"])
        state = {**snapshot["state"], "answers": [{**snapshot["state"]["answers"][0], "bound": "1/0"}]}
        for wrong, start in (
            ({"snapshot": {**snapshot, "state": {"schema": "x"}}}, ""),
            ({"snapshot": {**snapshot, "state": state}}, "snapshot: bound: expected a finite number"),
            ({"snapshot": snapshot, "task": ASKED["task"]}, "body: expected a task or a snapshot"),
            ({}, "body: expected a task or a snapshot"),
        ):
            answer = other.post("/sessions", wrong)
            assert answer.status_code == 422
            assert answer.json()["error"].startswith(start)
