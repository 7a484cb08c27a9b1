"""Requests that are sent again, since nobody knows whether they were answered: they are worked on once.

A request with an ``Idempotency-Key`` is finished though its client goes away, and its answer is kept for a
while: the same request under the same key is answered with it, or waits for it.  Answers that say "try again"
are not kept.
"""

import asyncio
import time
from collections import OrderedDict
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Final

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_HEADER: Final = "idempotency-key"
_LONGEST: Final = 200
"""Letters of a key."""
_AGAIN: Final = (408, 409, 429)
_STREAMED: Final = b"text/event-stream"


@dataclass(slots=True)
class _KeptReply:
    """A request under a key, and its answer."""

    digest: bytes
    used: float
    answer: list[Message] = field(default_factory=list)
    done: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def size(self) -> int:
        return sum(len(message.get("body", b"")) for message in self.answer)


class Repeats:
    """Middleware that answers a request repeated under its key, soon, as it was answered before."""

    def __init__(self, app: ASGIApp, most: int, bytes_: int, seconds: float) -> None:
        self._app = app
        self._most = most
        self._bytes = bytes_
        self._seconds = seconds
        self._kept: OrderedDict[str, _KeptReply] = OrderedDict()
        self._working: set[asyncio.Task[None]] = set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on what has no key."""
        key = Headers(scope=scope).get(_HEADER) if scope["type"] == "http" else None
        if key is None or scope["method"] != "POST":
            await self._app(scope, receive, send)
            return
        if not 0 < len(key) <= _LONGEST:
            refused = JSONResponse({"error": f"Idempotency-Key: expected up to {_LONGEST} letters"}, 422)
            await refused(scope, receive, send)
            return
        try:
            body = await _read(receive)
        except HTTPException as error:
            await JSONResponse({"error": error.detail}, error.status_code)(scope, receive, send)
            return
        asked = scope["path"].encode() + b"?" + scope["query_string"]
        digest = sha256(asked + b"\0" + body).digest()
        await self._answer(key, digest, body, scope, send)

    async def _answer(self, key: str, digest: bytes, body: bytes, scope: Scope, send: Send) -> None:
        known = self._forget(key).get(key)
        if known is not None and known.digest != digest:
            line = "Idempotency-Key: was given to another request before"
            await JSONResponse({"error": line}, 422)(scope, _nothing_more, send)
            return
        repeated = known is not None
        if known is None:
            known = self._kept[key] = _KeptReply(digest, time.monotonic())
            work = asyncio.create_task(self._work(key, known, body, scope))
            self._working.add(work)
            work.add_done_callback(self._working.discard)
        known.used = time.monotonic()
        self._kept.move_to_end(key)
        await known.done.wait()
        for message in known.answer:
            if repeated and message["type"] == "http.response.start":
                message = {**message, "headers": [*message["headers"]]}
                MutableHeaders(scope=message)["Idempotency-Replayed"] = "true"
            await send(message)

    async def _work(self, key: str, kept: _KeptReply, body: bytes, scope: Scope) -> None:
        """Have a request answered, whoever still waits for it."""
        whole: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

        async def receive() -> Message:
            return whole.pop() if whole else await _nothing_more()

        async def send(message: Message) -> None:
            kept.answer.append(message)

        try:
            await self._app(scope, receive, send)
        except Exception:
            line = b'{"error": "the server failed on this request: please report it"}'
            head = [(b"content-type", b"application/json")]
            kept.answer = [
                {"type": "http.response.start", "status": 500, "headers": head},
                {"type": "http.response.body", "body": line},
            ]
            raise
        finally:
            if not kept.answer or not _stays(kept.answer[0]):
                self._kept.pop(key, None)
            kept.done.set()

    def _forget(self, asked: str) -> OrderedDict[str, _KeptReply]:
        """What is kept, with room for a key that is asked; nothing that is worked on is forgotten."""
        oldest = time.monotonic() - self._seconds
        most = self._most if asked in self._kept else self._most - 1
        done = [key for key, kept in self._kept.items() if kept.done.is_set()]
        size = sum(self._kept[key].size for key in done)
        for key in done:
            kept = self._kept[key]
            much = size > self._bytes or len(self._kept) > most
            if kept.used < oldest or (much and key != asked):
                size -= kept.size
                del self._kept[key]
        return self._kept


def _stays(start: Message) -> bool:
    """Whether an answer is kept: what says that it may be another one next time is not, nor a stream."""
    status = start["status"]
    streamed = dict(start["headers"]).get(b"content-type", b"").startswith(_STREAMED)
    return status < 500 and status not in _AGAIN and not streamed


async def _read(receive: Receive) -> bytes:
    parts = []
    while True:
        message = await receive()
        parts.append(message.get("body", b""))
        if message["type"] != "http.request" or not message.get("more_body", False):
            return b"".join(parts)


async def _nothing_more() -> Message:
    """The client of a request that is worked on whatever happens to them never goes away."""
    await asyncio.Event().wait()
    raise AssertionError
