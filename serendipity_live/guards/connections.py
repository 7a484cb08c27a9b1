"""Connections: the address that a server listens on, and an application there that no client can hold."""

import asyncio
import errno
import ipaddress
import os
import signal
import socket
from collections.abc import Sequence
from typing import Any, ClassVar, Final

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

from serendipity.model import UsageError
from serendipity_live.guards.draining import Draining

_BACKLOG: Final = 2048

_ANYWHERE: Final = ("0.0.0.0", "::")
"""Addresses that stand for every address of the machine."""


def loopback(host: str) -> bool:
    """Whether a host is this machine, and reached from nowhere else."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def listening(host: str, port: int) -> socket.socket:
    """A socket that listens on a port, 0 for any that is free."""
    if not 0 <= port <= 65535:
        raise UsageError(f"--port: expected a number from 0 to 65535, got {port}")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    made = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # what has just ended holds the port no longer
            made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind((host, port))
        made.listen(_BACKLOG)
    except OSError as error:
        made.close()
        raise UsageError(_refused(host, port, error)) from None
    return made


def _refused(host: str, port: int, error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return f"--port: {port} is in use on {host}: name another one, or 0 for any that is free"
    if error.errno == errno.EACCES:
        return f"--port: {port} is not allowed to you: name one above 1023, or 0 for any that is free"
    return f"--host: {host} can't be listened on: {(error.strerror or str(error)).lower()}"


def url(listener: socket.socket) -> str:
    """Where a listening socket is reached."""
    host, port = listener.getsockname()[:2]
    return f"http://{f'[{host}]' if ':' in host else host}:{port}"


def hosts(host: str, more: Sequence[str] = ()) -> list[str]:
    """What a request's ``Host`` may say, ports apart, so that no other site's name leads here."""
    own = [] if host in _ANYWHERE else [host]
    local = ["localhost", "127.0.0.1", "::1"] if loopback(host) or host in _ANYWHERE else []
    return sorted({name.lower() for name in (*own, *local, *more)})


_CONNECTIONS: Final = 1000
"""At once; those beyond are told to come again."""

_STEP: Final = 0.02
"""Seconds between looks at what is still open."""

_GOODBYE: Final = 1
"""Seconds that requests have to end in when the server is stopped."""


class ImpatientProtocol(H11Protocol):
    """HTTP of uvicorn, which by itself waits for the rest of a request's head without end."""

    seconds: ClassVar = 20.0
    """Until the head of a request has to be there."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._patience: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Start to wait."""
        super().connection_made(transport)
        self._wait()

    def data_received(self, data: bytes) -> None:
        """Wait no longer where that was the end of a head, and else go on waiting."""
        super().data_received(data)
        if self._answering():
            self._stop_waiting()
        elif self._patience is None:
            self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Nothing to wait for any more."""
        self._stop_waiting()
        super().connection_lost(exc)

    def _answering(self) -> bool:
        return self.cycle is not None and not self.cycle.response_complete

    def _wait(self) -> None:
        self._patience = self.loop.call_later(self.seconds, self._lose_patience)

    def _stop_waiting(self) -> None:
        if self._patience is not None:
            self._patience.cancel()
            self._patience = None

    def _lose_patience(self) -> None:
        self._patience = None
        if not self._answering() and self.transport.get_protocol() is self:  # else it is a websocket by now
            self.transport.close()


class _Server(uvicorn.Server):
    """One that drains when SIGTERM comes, where it may take its time."""

    def __init__(self, config: uvicorn.Config, draining: Draining, seconds: float) -> None:
        super().__init__(config)
        self._draining = draining
        self._seconds = seconds
        self._loop: asyncio.AbstractEventLoop | None = None

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Remember the loop, for signals."""
        self._loop = asyncio.get_running_loop()
        await super().startup(sockets)

    def handle_exit(self, sig: int, frame: Any) -> None:
        """Drain first; a second signal ends the server at once."""
        if sig != signal.SIGTERM or self._draining.begun or self._loop is None or not self._seconds:
            super().handle_exit(sig, frame)
            return
        self._draining.begun = True
        asyncio.run_coroutine_threadsafe(self._drain(), self._loop)

    async def _drain(self) -> None:
        end = asyncio.get_running_loop().time() + self._seconds
        while self._draining.open and asyncio.get_running_loop().time() < end:
            await asyncio.sleep(_STEP)
        self.should_exit = True


def serve(app: Any, listener: socket.socket, draining: Draining | None = None, seconds: float = 0) -> None:
    """Answer requests to an ASGI application, on a socket that listens, until a signal ends it.

    SIGTERM has an application with ``draining`` answer what it has begun first, for that many seconds.
    """
    config = uvicorn.Config(
        app,
        http=ImpatientProtocol,
        ws="websockets-sansio",
        log_config=None,
        log_level="critical",
        access_log=False,
        server_header=False,
        limit_concurrency=_CONNECTIONS,
        timeout_graceful_shutdown=_GOODBYE,
    )
    _Server(config, draining or Draining(), seconds).run(sockets=[listener])
