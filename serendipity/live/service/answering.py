"""From workers' messages to responses of HTTP, as long as the client is there to hear them."""

import asyncio
import json
from collections.abc import AsyncGenerator, AsyncIterator, Coroutine
from contextlib import aclosing, suppress
from typing import Any, Final, TypeVar

from sse_starlette import EventSourceResponse, ServerSentEvent
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from serendipity.live.service.sessions import Remembered
from serendipity.live.workers.pool import BusyError, LostError, Pool

T = TypeVar("T")

_SEND: Final = 30.0
"""Seconds in which a client has to take an event."""

_AGAIN: Final = {"Retry-After": "1"}

Answers = AsyncGenerator[bytes, None]
"""What is answered to a call, as JSON text, one answer after the other."""


class GoneError(Exception):
    """Nobody waits for the answer any more."""


async def answers(pool: Pool, job: str, body: bytes, session: Remembered | None = None) -> Answers:
    """The answers to a job; a session is moved to where a call has left it.

    Raises:
        HTTPException: it has none, or its worker can't say it.
    """
    try:
        async with aclosing(pool.run(job, body)) as messages:
            async for message in messages:
                if message.head["kind"] == "error":
                    raise HTTPException(message.head["status"], message.head["error"])
                if message.head.get("state") and session is not None:
                    session.move(message.body)
                elif message.head["kind"] == "answer":
                    yield message.body
    except BusyError:
        line = f"all workers are busy, and {pool.limits.queue} requests wait for them: try again"
        raise HTTPException(429, line, _AGAIN) from None
    except LostError as lost:
        raise HTTPException(503, str(lost), _AGAIN) from None


async def all_of(request: Request, given: Answers) -> list[bytes]:
    """All answers.

    Raises:
        HTTPException: there are none.
        GoneError: the client went away before.
    """

    async def collected() -> list[bytes]:
        async with aclosing(given):
            return [body async for body in given]

    return await _unless_gone(request, collected())


async def as_json(request: Request, given: Answers) -> Response:
    """A response with the only answer; see :func:`all_of`."""
    (body,) = await all_of(request, given)
    return Response(body, media_type="application/json")


async def as_events(request: Request, given: Answers) -> Response:
    """A response that says each answer as it comes: events ``answer``, and then ``end`` or ``error``.

    Raises:
        HTTPException: there is not even a first answer.
        GoneError: the client went away before it.
    """
    try:
        first = await _unless_gone(request, anext(given))
    except BaseException:
        with suppress(RuntimeError):
            await given.aclose()
        raise
    return EventSourceResponse(_events(first, given), send_timeout=_SEND)


async def _events(first: bytes, given: Answers) -> AsyncIterator[ServerSentEvent]:
    async with aclosing(given):
        try:
            yield ServerSentEvent(first.decode(), event="answer")
            async for body in given:
                yield ServerSentEvent(body.decode(), event="answer")
            yield ServerSentEvent("{}", event="end")
        except HTTPException as error:
            told = json.dumps({"error": error.detail, "status": error.status_code})
            yield ServerSentEvent(told, event="error")


async def _unless_gone(request: Request, work: Coroutine[Any, Any, T]) -> T:
    """What ``work`` returns, which is cancelled when the client goes away."""
    working = asyncio.create_task(work)
    leaving = asyncio.create_task(_left(request))
    try:
        await asyncio.wait((working, leaving), return_when=asyncio.FIRST_COMPLETED)
        if not working.done():
            raise GoneError
        return working.result()
    finally:
        for task in (working, leaving):
            task.cancel()
        await asyncio.gather(working, leaving, return_exceptions=True)


async def _left(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
