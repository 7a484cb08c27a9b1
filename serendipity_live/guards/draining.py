"""Draining: a server that is to end takes nothing new, and ends once it has answered what it has begun."""

from typing import Final

from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send

_LINE: Final = "the server is about to end: ask another one"
_HEADERS: Final = {"Retry-After": "1", "Connection": "close"}


class Draining:
    """Whether a server takes requests, and how many it has not answered yet."""

    def __init__(self) -> None:
        self.begun = False
        self.open = 0


class Drained:
    """Middleware that refuses what is asked of a draining server; what only looks at it is still answered."""

    def __init__(self, app: ASGIApp, draining: Draining) -> None:
        self._app = app
        self._draining = draining

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on and count, or refuse."""
        if scope["type"] != "http" or scope["method"] in ("GET", "HEAD"):
            await self._app(scope, receive, send)
        elif self._draining.begun:
            await JSONResponse({"error": _LINE}, 503, _HEADERS)(scope, receive, send)
        else:
            self._draining.open += 1
            try:
                await self._app(scope, receive, send)
            finally:
                self._draining.open -= 1
