"""Servers side by side: whoever ends hands on, and whoever asks again is answered once."""

import asyncio
import signal
import time
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import httpx
import pytest
from starlette.responses import PlainTextResponse

from serendipity.live.service.repeats import Repeats
from tests.live.server import Server, serving, until

ROOM2 = {"task": {"example": "room2"}, "options": {"discount": 0.6}}
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
        refused = server.post("/plan", ROOM2)
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
    first = server.post("/plan", ROOM2, headers=KEY)
    again = server.post("/plan", ROOM2, headers=KEY)
    assert first.status_code == 200
    assert "idempotency-replayed" not in first.headers
    assert again.headers["idempotency-replayed"] == "true"
    assert again.content == first.content  # with the seconds that it took
    for path, body in (("/plan", {**ROOM2, "options": {"discount": 0.7}}), ("/verify", ROOM2)):
        other = server.post(path, body, headers=KEY)
        assert (other.status_code, other.json()["error"][:16]) == (422, "Idempotency-Key:")
    assert server.post("/plan", ROOM2, headers={"Idempotency-Key": "x" * 201}).status_code == 422


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
    path = "/sessions/" + server.post("/sessions", ROOM2).json()["id"]
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
        assert server.post("/plan", ROOM2, headers=KEY).status_code == 429
        until(lambda: server.busy == 0)
        answer = server.post("/plan", ROOM2, headers=KEY)
        assert answer.status_code == 200
        assert "idempotency-replayed" not in answer.headers


@pytest.mark.long
def test_a_session_goes_on_at_another_server() -> None:
    with serving("--workers", "1") as one, serving("--workers", "1") as other:
        path = "/sessions/" + one.post("/sessions", ROOM2).json()["id"]
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
        for wrong, start in (
            ({"snapshot": {**snapshot, "state": {"schema": "x"}}}, ""),
            ({"snapshot": snapshot, "task": ROOM2["task"]}, "body: expected a task or a snapshot"),
            ({}, "body: expected a task or a snapshot"),
        ):
            answer = other.post("/sessions", wrong)
            assert answer.status_code == 422
            assert answer.json()["error"].startswith(start)
