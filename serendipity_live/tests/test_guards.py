"""Clients that take their time, and pages that do not listen: they hold nobody up."""

import asyncio
import json
import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
import uvicorn
from fastapi import FastAPI, WebSocketDisconnect
from starlette.middleware import Middleware

from serendipity.model import UsageError
from serendipity_live.guards import connections
from serendipity_live.guards.connections import ImpatientProtocol
from serendipity_live.guards.middleware import BodyLimits
from serendipity_live.play.application import _Pages
from serendipity_live.service.answering import HANDLERS

HEAD = "POST / HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 2\r\n\r\n"


class VeryImpatient(ImpatientProtocol):
    seconds = 0.3


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    app = FastAPI(middleware=[Middleware(BodyLimits, most=100, seconds=0.3)], exception_handlers=HANDLERS)

    @app.post("/")
    async def answer(body: dict[str, int]) -> dict[str, int]:
        return body

    with connections.listening("127.0.0.1", 0) as listener:
        config = uvicorn.Config(app, http=VeryImpatient, ws="none", log_config=None, timeout_keep_alive=1)
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        while not server.started:
            time.sleep(0.01)
        yield listener.getsockname()[1]
        server.should_exit = True
        thread.join()


@pytest.mark.parametrize(
    ("said", "answer"),
    [
        ("", b""),
        ("POST / HT", b""),
        (f"{HEAD}{{}}POST / HT", b"HTTP/1.1 200 OK"),
        (f"{HEAD}{{", b"HTTP/1.1 408 Request Timeout"),
        (f"{HEAD}{{}}", b"HTTP/1.1 200 OK"),
    ],
    ids=["silent", "half a head", "half a second head", "half a body", "whole"],
)
def test_nobody_is_waited_for_without_end(port: int, said: str, answer: bytes) -> None:
    with socket.create_connection(("127.0.0.1", port), timeout=10) as slow:
        slow.sendall(said.encode())
        heard = b"".join(iter(lambda: slow.recv(4096), b""))
    assert heard.partition(b"\r\n")[0] == answer


@pytest.mark.parametrize(
    ("host", "local"),
    [
        ("127.0.0.1", True),
        ("127.8.8.8", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("::", False),
        ("192.0.2.1", False),
        ("example.org", False),
    ],
)
def test_which_addresses_only_this_machine_reaches(host: str, local: bool) -> None:
    assert connections.loopback(host) is local
    assert ("localhost" in connections.hosts(host)) is (local or host in ("0.0.0.0", "::"))


class Room:
    def view(self) -> dict[str, Any]:
        return {}

    def do(self, message: dict[str, Any]) -> dict[str, Any]:
        if message["do"] == "refuse":
            raise UsageError("no")
        return {"kind": "answer"}


class Socket:
    """A page that says some things, and takes so many."""

    def __init__(self, says: list[str], takes: int) -> None:
        self.says = says
        self.takes = takes
        self.told: list[str] = []

    async def accept(self) -> None:
        pass

    async def receive_text(self) -> str:
        if not self.says:
            raise WebSocketDisconnect
        return json.dumps({"do": self.says.pop(0)})

    async def send_json(self, message: dict[str, Any]) -> None:
        if len(self.told) == self.takes:
            await asyncio.Event().wait()
        self.told.append(message["kind"])


@pytest.mark.parametrize("asks", ["ask", "refuse"])
def test_a_page_that_does_not_listen_holds_nobody_up(asks: str) -> None:
    async def both() -> list[str]:
        pages = _Pages(Room())  # type: ignore[arg-type]
        deaf = asyncio.create_task(pages.serve(Socket([asks], takes=1)))  # type: ignore[arg-type]
        await asyncio.sleep(0.1)
        other = Socket(["ask", "refuse", "ask"], takes=9)
        try:
            async with asyncio.timeout(5):
                await pages.serve(other)  # type: ignore[arg-type]
        finally:
            deaf.cancel()
        return other.told

    assert asyncio.run(both()) == ["view", "answer", "refused", "answer"]
