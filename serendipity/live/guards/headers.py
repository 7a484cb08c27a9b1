"""What every response says to browsers: nothing is loaded from elsewhere, and nothing appears elsewhere."""

from typing import Final

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_POLICY: Final = (
    "default-src 'self'; script-src {}; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
)
_HEADERS: Final = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}


class Headed:
    """Middleware that adds them.

    Args:
        app: who answers.
        inline: whether pages have scripts in them, and not beside them.
    """

    def __init__(self, app: ASGIApp, *, inline: bool) -> None:
        self._app = app
        scripts = "'self' 'unsafe-inline'" if inline else "'self'"
        self._headers = {**_HEADERS, "Content-Security-Policy": _POLICY.format(scripts)}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, with the headers added."""

        async def headed(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(self._headers)
            await send(message)

        await self._app(scope, receive, headed if scope["type"] == "http" else send)
