"""Calls that stand for themselves: plan, plan with answers on the way, verify."""

from collections.abc import AsyncGenerator
from contextlib import aclosing
from typing import Any, Final

from fastapi import APIRouter, Request, Response

from serendipity.live.service import requests as asked
from serendipity.live.service.answering import as_events, as_json, bodies, frames_of, unless_gone
from serendipity.live.workers.pool import Pool

Described = dict[int | str, dict[str, Any]]


def _says(description: str, kind: str = "application/json") -> Described:
    schema = {"type": "object" if kind == "application/json" else "string"}
    return {200: {"description": description, "content": {kind: {"schema": schema}}}}


RESULT: Final = _says("schema `serendipity.result/1`")
CERTIFICATE: Final = _says("schema `serendipity.certificate/1`")
STREAM: Final = _says(
    "events `answer` with results that get better; then `end`, or `error`", "text/event-stream"
)


def call_router(pool: Pool) -> APIRouter:
    """The paths of these calls."""
    router = APIRouter(tags=["calls"])

    @router.post("/plan", responses=RESULT, response_class=Response)
    async def plan(call: asked.PlanRequest, request: Request) -> Response:
        """The best plan in which robots help the human, with a proof that none is better."""
        return as_json(await unless_gone(request, _only(pool, "plan", call)))

    @router.post("/plan/anytime", responses=STREAM, response_class=Response)
    async def plan_anytime(call: asked.AnytimeRequest, request: Request) -> Response:
        """The same with answers on the way, as server-sent events; the last one stands."""
        return await as_events(request, _each(pool, "plan_anytime", call))

    @router.post("/verify", responses=CERTIFICATE, response_class=Response)
    async def verify(call: asked.VerifyRequest, request: Request) -> Response:
        """Check a result claim by claim, independently of the search."""
        return as_json(await unless_gone(request, _only(pool, "verify", call)))

    return router


async def _only(pool: Pool, job: str, call: asked.Asked) -> bytes:
    (body,) = await bodies(frames_of(pool, job, call.model_dump_json().encode()))
    return body


async def _each(pool: Pool, job: str, call: asked.Asked) -> AsyncGenerator[bytes, None]:
    async with aclosing(frames_of(pool, job, call.model_dump_json().encode())) as frames:
        async for frame in frames:
            yield frame.body
