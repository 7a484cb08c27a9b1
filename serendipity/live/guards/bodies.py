"""How much a request may say, and how long it may take to say it."""

import asyncio

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send


class BodyLimits:
    """Middleware that ends requests whose bodies are too long, or too long in coming.

    Args:
        most: bytes of a body.
        seconds: until all of it has to be there.
    """

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
