"""Calls of sessions: a task that moves on epoch by epoch, and is planned for again and again."""

from collections.abc import AsyncGenerator
from contextlib import aclosing
from typing import Any

from fastapi import APIRouter, Request, Response

from serendipity.live.service import requests as asked
from serendipity.live.service.answering import as_events, as_json, bodies, frames_of, unless_gone
from serendipity.live.service.calls import RESULT, STREAM
from serendipity.live.service.sessions import Remembered, Sessions
from serendipity.live.workers.pool import Pool


def session_router(pool: Pool, sessions: Sessions) -> APIRouter:
    """The paths of these calls."""
    router = APIRouter(prefix="/sessions", tags=["sessions"])

    async def moved(request: Request, name: str, call: str, given: asked.Asked) -> dict[str, Any]:
        with sessions.calling(name) as session:
            await unless_gone(request, _said(pool, session, call, given.model_dump()))
            return session.stands

    @router.post("", status_code=201, response_model=asked.SessionState)
    async def begin(call: asked.SessionRequest, request: Request) -> dict[str, Any]:
        """Begin a session."""
        session = sessions.begin(call.model_dump())
        await unless_gone(request, _said(pool, session, "begin", {}))
        sessions.add(session)
        return session.stands

    @router.get("/{name}", response_model=asked.SessionState)
    async def state(name: str) -> dict[str, Any]:
        """Where a session stands."""
        return sessions.named(name).stands

    @router.delete("/{name}", status_code=204)
    async def end(name: str) -> None:
        """End a session."""
        sessions.end(name)

    @router.post("/{name}/plan", responses=RESULT, response_class=Response)
    async def plan(name: str, call: asked.SessionPlanRequest, request: Request) -> Response:
        """The best answer from where the session stands."""
        with sessions.calling(name) as session:
            (body,) = await unless_gone(request, _said(pool, session, "plan", call.model_dump()))
            return as_json(body)

    @router.post("/{name}/plan/anytime", responses=STREAM, response_class=Response)
    async def plan_anytime(name: str, call: asked.SessionPlanRequest, request: Request) -> Response:
        """The same with answers on the way, as server-sent events; the last one stands."""
        return await as_events(request, _each(pool, sessions, name, call))

    @router.post("/{name}/execute", response_model=asked.SessionState)
    async def execute(name: str, call: asked.ExecuteRequest, request: Request) -> dict[str, Any]:
        """Move on by one epoch in which these actions were executed (none: everybody waited)."""
        return await moved(request, name, "execute", call)

    @router.post("/{name}/change", response_model=asked.SessionState)
    async def change(name: str, call: asked.ChangeRequest, request: Request) -> dict[str, Any]:
        """Set facts to true or false, as they were seen."""
        return await moved(request, name, "change", call)

    @router.post("/{name}/goal", response_model=asked.SessionState)
    async def set_goal(name: str, call: asked.GoalRequest, request: Request) -> dict[str, Any]:
        """Give the human another goal: facts, with ``!`` in front of those to be false."""
        return await moved(request, name, "set_goal", call)

    return router


async def _said(pool: Pool, session: Remembered, call: str, given: dict[str, Any]) -> list[bytes]:
    """What a call answers; what is said last is where it leaves the session."""
    *answers, state = await bodies(frames_of(pool, "session", session.asked(call, given)))
    session.move(state)
    return answers


async def _each(
    pool: Pool, sessions: Sessions, name: str, call: asked.SessionPlanRequest
) -> AsyncGenerator[bytes, None]:
    with sessions.calling(name) as session:
        body = session.asked("plan_anytime", call.model_dump())
        async with aclosing(frames_of(pool, "session", body)) as frames:
            async for frame in frames:
                if frame.head.get("state"):
                    session.move(frame.body)
                else:
                    yield frame.body
