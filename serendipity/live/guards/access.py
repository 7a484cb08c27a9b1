"""Who may ask: requests for this host, from no other site's page, and with the token where there is one."""

import secrets
from collections.abc import Sequence
from typing import Final
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send

_OPEN: Final = ("/health", "/docs", "/openapi.json", "/static-offline-docs/")
"""Paths that need no token: nothing of what is asked or answered is there."""


class Access:
    """Middleware that refuses others.

    Args:
        hosts: what ``Host`` may say, ports apart.
        token: what has to come as ``Authorization: Bearer TOKEN``, or None.
    """

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
