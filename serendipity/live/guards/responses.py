"""Responses: what each says to browsers, and the line of log that it leaves."""

import logging
import re
import secrets
from collections.abc import Callable
from time import perf_counter
from typing import Final

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_LOG = logging.getLogger(__name__)

_SECRET: Final = re.compile(r"^/(s|live|experimenter)/[^/]+")
"""How addresses begin that nobody should know who has not been told."""

_POLICY: Final = (
    "default-src 'self'; script-src {}; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
)
"""Nothing is loaded from elsewhere, and nothing appears elsewhere."""

GONE: Final = 499
"""The status where the client went away before there was an answer."""

Count = Callable[[Scope, int, float], None]
"""Is told of a request, its status, and the seconds that it took."""


class Responses:
    """Middleware that adds headers to responses, and logs who asked what, how it ended and how long it took.

    Each request has an id, which its response names (``X-Request-Id``) and its line of log ends with.
    Secrets in addresses are left out.

    Args:
        inline: whether pages have scripts in them, and not beside them.
        count: told of each response, too.
    """

    def __init__(self, app: ASGIApp, *, inline: bool, count: Count | None = None) -> None:
        self._app = app
        self._count = count
        self._headers = {
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Content-Security-Policy": _POLICY.format("'self' 'unsafe-inline'" if inline else "'self'"),
        }

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, and note what comes back."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request, begun, status, said = secrets.token_hex(4), perf_counter(), GONE, 0

        async def noted(message: Message) -> None:
            nonlocal status, said
            if message["type"] == "http.response.start":
                status = message["status"]
                MutableHeaders(scope=message).update({**self._headers, "X-Request-Id": request})
            said += len(message.get("body", b""))
            await send(message)

        try:
            await self._app(scope, receive, noted)
        finally:
            seconds = perf_counter() - begun
            if self._count is not None:
                self._count(scope, status, seconds)
            client = (scope.get("client") or ("-",))[0]
            asked = f"{scope['method']} " + _SECRET.sub(r"/\1/...", scope["path"])
            end = "gone" if status == GONE else status
            _LOG.info("%s %.200r %s %d bytes %.3f s %s", client, asked, end, said, seconds, request)
