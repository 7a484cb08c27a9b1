"""Connections: an application on a socket, which slow clients can't hold."""

import asyncio
import socket
from typing import Any, ClassVar, Final

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

_CONNECTIONS: Final = 1000
"""At once; those beyond are told to come again."""

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


def serve(app: Any, listener: socket.socket) -> None:
    """Answer requests to an ASGI application, on a socket that listens, until a signal ends it."""
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
    uvicorn.Server(config).run(sockets=[listener])
