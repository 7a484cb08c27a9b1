"""Responses of HTTP, made of workers' messages as long as the client is there, or of what is wrong.

A refusal is a status, and the one line that the command line says, too.
"""

import asyncio
import json
import logging
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Coroutine, Mapping
from contextlib import aclosing, suppress
from typing import Any, Final, TypeVar

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic_core import PydanticSerializationError
from sse_starlette import EventSourceResponse, ServerSentEvent
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse

from serendipity_live.guards.middleware import GONE
from serendipity_live.service.requests import Refusal
from serendipity_live.service.sessions import Remembered
from serendipity_live.workers.pool import BusyError, LostError, Pool

T = TypeVar("T")

_SEND: Final = 30.0
"""Seconds in which a client has to take an event."""

_AGAIN: Final = {"Retry-After": "1"}

Answers = AsyncGenerator[bytes, None]
"""What is answered to a call, as JSON text, one answer after the other."""


class GoneError(Exception):
    """Nobody waits for the answer any more."""


async def answers(pool: Pool, job: str, body: bytes, session: Remembered | None = None) -> Answers:
    """The answers to a job, or an HTTPException; a session is moved to where a call has left it."""
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


REFUSALS: Final[dict[int | str, dict[str, Any]]] = {
    status: {"model": Refusal, "description": about}
    for status, about in (
        (400, "no JSON, or another host's name"),
        (408, "the body took too long"),
        (413, "the body is too large"),
        (422, "the request, the task or an option is wrong: the line that the command line says"),
        (429, "all workers are busy and the queue is full: try again"),
        (503, "the worker was lost: try again"),
        (504, "the time limit came before there was anything to answer"),
        (507, "memory is used up"),
    )
}


async def _refused(_request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return JSONResponse({"error": error.detail}, error.status_code, error.headers)


async def _malformed(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    if first["type"] == "json_invalid":
        found = first.get("ctx", {}).get("error", "it can't be read")
        return JSONResponse({"error": f"body: expected JSON: {found}"}, 400)
    if first["loc"] == ("body",) and "json" not in request.headers.get("content-type", ""):
        return JSONResponse({"error": "body: expected JSON, and 'Content-Type: application/json'"}, 422)
    return JSONResponse({"error": line_of({**first, "loc": first["loc"][1:]}, "body")}, 422)


def line_of(error: Mapping[str, Any], whole: str) -> str:
    """What is wrong with a part of a request, in a line; all parts together are called ``whole``."""
    where = ".".join(str(part) for part in error["loc"]) or whole
    found = error["msg"].removeprefix("Value error, ")
    return f"{where}: {found[:1].lower()}{found[1:]}"


async def _too_deep(_request: Request, _error: Exception) -> Response:
    return JSONResponse({"error": "body: it is nested too deeply"}, 422)


async def _broken(request: Request, error: Exception) -> Response:
    log = logging.getLogger("serendipity.live.service.refusals")
    log.error("%s failed", request.url.path, exc_info=error)
    return JSONResponse({"error": "the server failed on this request: please report it"}, 500)


async def _gone(_request: Request, _error: Exception) -> Response:
    return Response(status_code=GONE)


HANDLERS: Final[dict[Any, Callable[[Request, Exception], Coroutine[Any, Any, Response]]]] = {
    HTTPException: _refused,
    RequestValidationError: _malformed,
    GoneError: _gone,
    RecursionError: _too_deep,
    PydanticSerializationError: _too_deep,
    Exception: _broken,
}
"""By what is raised."""
