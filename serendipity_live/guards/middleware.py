"""Middleware: who may ask and how much, and what responses say to browsers and leave in the log."""

import asyncio
import logging
import re
import secrets
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Final
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_OPEN: Final = ("/health", "/ready", "/docs", "/openapi.json", "/static-offline-docs/")
"""Paths that need no token: nothing of what is asked or answered is there."""


class Access:
    """Middleware that refuses other hosts, ports apart, and requests without the token, if there is one."""

    def __init__(self, app: ASGIApp, hosts: Sequence[str], token: str | None = None) -> None:
        self._app = app
        self._hosts = frozenset(hosts)
        self._token = token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on what is let in."""
        if scope["type"] in ("http", "websocket"):
            refused = self._refused(Headers(scope=scope), scope["path"])
            if refused is not None:
                await refused(scope, receive, send)
                return
        await self._app(scope, receive, send)

    def _refused(self, headers: Headers, path: str) -> JSONResponse | None:
        host = headers.get("host", "")
        name = _name(host)
        if name is None or name not in self._hosts:
            return _no(400, f"Host: expected one of {', '.join(sorted(self._hosts))}, got '{host:.100}'")
        origin = headers.get("origin")
        if origin is not None and urlsplit(origin).netloc.lower() != host.lower():
            return _no(403, f"Origin: requests from pages of '{origin:.100}' are not answered")
        if self._token is not None and not path.startswith(_OPEN):
            kind, _, given = headers.get("authorization", "").partition(" ")
            if kind.lower() != "bearer" or not secrets.compare_digest(given.encode(), self._token.encode()):
                refused = _no(401, "Authorization: expected 'Bearer TOKEN' with the token of this server")
                refused.headers["www-authenticate"] = "Bearer"
                return refused
        return None


def _no(status: int, line: str) -> JSONResponse:
    return JSONResponse({"error": line}, status)


def _name(host: str) -> str | None:
    """The name or address in a ``Host`` header, without its port; None where there is none."""
    try:
        return urlsplit(f"//{host}").hostname
    except ValueError:
        return None


class BodyLimits:
    """Middleware that ends requests whose bodies have too many bytes, or take too many seconds in coming."""

    def __init__(self, app: ASGIApp, most: int, seconds: float) -> None:
        self._app = app
        self._most = most
        self._seconds = seconds

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on what keeps the limits; those that don't are answered where the body is read."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        declared = Headers(scope=scope).get("content-length", "")
        end = asyncio.get_running_loop().time() + self._seconds
        read, whole = 0, False

        async def limited() -> Message:
            nonlocal read, whole
            if whole:
                return await receive()
            if declared.isdecimal() and int(declared[:20]) > self._most:
                raise self._too_long()
            try:
                async with asyncio.timeout_at(end):
                    message = await receive()
            except TimeoutError:
                line = f"body: expected all of it within {self._seconds:g} seconds"
                raise HTTPException(408, line) from None
            read += len(message.get("body", b""))
            whole = not message.get("more_body", False)
            if read > self._most:
                raise self._too_long()
            return message

        await self._app(scope, limited, send)

    def _too_long(self) -> HTTPException:
        return HTTPException(413, f"body: expected at most {self._most} bytes")


_LOG = logging.getLogger("serendipity.live.guards.responses")  # whoever filters logs knows that name

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
