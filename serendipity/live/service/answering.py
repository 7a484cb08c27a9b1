"""From workers' frames to responses of HTTP, as long as the client is there to hear them."""

import asyncio
import json
from collections.abc import AsyncGenerator, AsyncIterator, Coroutine
from contextlib import aclosing, suppress
from typing import Any, Final, TypeVar

from sse_starlette import EventSourceResponse, ServerSentEvent
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from serendipity.live.workers.frames import Frame
from serendipity.live.workers.pool import BusyError, LostError, Pool

T = TypeVar("T")

_SEND: Final = 30.0
"""Seconds in which a client has to take an event."""

_AGAIN: Final = {"Retry-After": "1"}

Frames = AsyncGenerator[Frame, None]


class GoneError(Exception):
    """Nobody waits for the answer any more."""


async def unless_gone(request: Request, work: Coroutine[Any, Any, T]) -> T:
    """What ``work`` returns, which is cancelled when the client goes away.

    Raises:
        GoneError: it has.
    """
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


async def frames_of(pool: Pool, job: str, body: bytes) -> Frames:
    """The answers to a job.

    Raises:
        HTTPException: it has none, or its worker can't say it.
    """
    try:
        async with aclosing(pool.run(job, body)) as frames:
            async for frame in frames:
                if frame.head["kind"] == "error":
                    raise HTTPException(frame.head["status"], frame.head["error"])
                if frame.head["kind"] == "answer":
                    yield frame
    except BusyError:
        line = f"all workers are busy, and {pool.limits.queue} requests wait for them: try again"
        raise HTTPException(429, line, _AGAIN) from None
    except LostError as lost:
        raise HTTPException(503, str(lost), _AGAIN) from None


async def bodies(frames: Frames) -> list[bytes]:
    """All answers of a job."""
    async with aclosing(frames):
        return [frame.body async for frame in frames]


def as_json(body: bytes) -> Response:
    """A response that says what a worker said."""
    return Response(body, media_type="application/json")


async def as_events(request: Request, answers: AsyncGenerator[bytes, None]) -> Response:
    """A response that says each answer as it comes: events ``answer``, and then ``end`` or ``error``.

    Raises:
        HTTPException: there is not even a first answer.
        GoneError: the client went away before it.
    """
    try:
        first = await unless_gone(request, anext(answers))
    except BaseException:
        with suppress(RuntimeError):
            await answers.aclose()
        raise
    return EventSourceResponse(_events(first, answers), send_timeout=_SEND)


async def _events(first: bytes, answers: AsyncGenerator[bytes, None]) -> AsyncIterator[ServerSentEvent]:
    async with aclosing(answers):
        try:
            yield _event("answer", first)
            async for body in answers:
                yield _event("answer", body)
            yield _event("end", b"{}")
        except HTTPException as error:
            yield _event("error", json.dumps({"error": error.detail, "status": error.status_code}).encode())


def _event(kind: str, body: bytes) -> ServerSentEvent:
    return ServerSentEvent(body.decode(), event=kind)
