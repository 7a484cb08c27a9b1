"""Clients that take their time, against a server in this process with little patience."""

import socket
import threading
import time
from collections.abc import Iterator

import pytest
import uvicorn
from fastapi import FastAPI
from starlette.middleware import Middleware

from serendipity.live.guards import connections
from serendipity.live.guards.connections import ImpatientProtocol
from serendipity.live.guards.middleware import BodyLimits
from serendipity.live.service.answering import HANDLERS

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
