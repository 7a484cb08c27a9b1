"""A line of log for each request."""

import logging
import re
import secrets
from time import perf_counter

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_LOG = logging.getLogger(__name__)

_SECRET = re.compile(r"^/(s|live|experimenter)/[^/]+")
"""How addresses begin that nobody should know who has not been told."""


class Logged:
    """Middleware that logs who asked what, how it ended, how much was said and how long it took.

    Each request has an id, which its response names (``X-Request-Id``) and its line ends with.  Secrets in
    addresses are left out.

    Args:
        app: who answers.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on and log."""
        if scope["type"] != "http" or not _LOG.isEnabledFor(logging.INFO):
            await self._app(scope, receive, send)
            return
        request, begun, status, said = secrets.token_hex(4), perf_counter(), "gone", 0

        async def noted(message: Message) -> None:
            nonlocal status, said
            if message["type"] == "http.response.start":
                status = str(message["status"])
                MutableHeaders(scope=message)["X-Request-Id"] = request
            said += len(message.get("body", b""))
            await send(message)

        try:
            await self._app(scope, receive, noted)
        finally:
            client = (scope.get("client") or ("-",))[0]
            asked = f"{scope['method']} " + _SECRET.sub(r"/\1/...", scope["path"])
            seconds = perf_counter() - begun
            _LOG.info("%s %.200r %s %d bytes %.3f s %s", client, asked, status, said, seconds, request)
