"""What is wrong with a request: a status, and the one line that the command line says, too."""

from collections.abc import Callable, Coroutine
from typing import Any, Final

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse

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

_CLOSED: Final = 499
"""Nobody hears it: the client closed the connection."""


async def _refused(_request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return JSONResponse({"error": error.detail}, error.status_code, error.headers)


async def _malformed(_request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    if first["type"] == "json_invalid":
        found = first.get("ctx", {}).get("error", "it can't be read")
        return JSONResponse({"error": f"body: expected JSON: {found}"}, 400)
    where = ".".join(str(part) for part in first["loc"][1:]) or "body"
    return JSONResponse({"error": f"{where}: {_lower(first['msg'])}"}, 422)


async def _gone(_request: Request, _error: Exception) -> Response:
    return Response(status_code=_CLOSED)


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]


HANDLERS: Final[dict[Any, Callable[[Request, Exception], Coroutine[Any, Any, Response]]]] = {
    HTTPException: _refused,
    RequestValidationError: _malformed,
    GoneError: _gone,
}
"""By what is raised."""
