"""What is wrong with a request: a status, and the one line that the command line says, too."""

import logging
from collections.abc import Callable, Coroutine
from typing import Any, Final

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic_core import PydanticSerializationError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse

from serendipity.live.guards.responses import GONE
from serendipity.live.service.answering import GoneError
from serendipity.live.service.requests import Refusal

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
    where = ".".join(str(part) for part in first["loc"][1:]) or "body"
    found = first["msg"].removeprefix("Value error, ")
    return JSONResponse({"error": f"{where}: {found[:1].lower()}{found[1:]}"}, 422)


async def _too_deep(_request: Request, _error: Exception) -> Response:
    return JSONResponse({"error": "body: it is nested too deeply"}, 422)


async def _broken(request: Request, error: Exception) -> Response:
    logging.getLogger(__name__).error("%s failed", request.url.path, exc_info=error)
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
