"""An application on a socket, until somebody stops it."""

import socket
from typing import Any, Final

import uvicorn

from serendipity.live.guards.connections import ImpatientProtocol

_CONNECTIONS: Final = 1000
"""At once; those beyond are told to come again."""

_GOODBYE: Final = 1
"""Seconds that requests have to end in when the server is stopped."""


def serve(app: Any, listener: socket.socket) -> None:
    """Answer requests until a signal ends it.

    Args:
        app: an ASGI application.
        listener: listens already.
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
    uvicorn.Server(config).run(sockets=[listener])
