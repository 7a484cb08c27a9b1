"""The service as an ASGI application."""

from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

from fastapi import FastAPI, Response
from fastapi_offline import FastAPIOffline
from starlette.middleware import Middleware

from serendipity import __version__
from serendipity.live.guards.access import Access
from serendipity.live.guards.bodies import BodyLimits
from serendipity.live.guards.responses import Responses
from serendipity.live.service.calls import call_router, session_router
from serendipity.live.service.metrics import Metrics
from serendipity.live.service.refusals import HANDLERS, REFUSALS
from serendipity.live.service.sessions import SessionStore
from serendipity.live.workers.pool import Pool, PoolLimits


@dataclass(frozen=True, slots=True)
class ServiceLimits:
    """What a service lets others use.

    Attributes:
        pool: processes, queue, time and memory.
        body: bytes of a request.
        body_seconds: until all of them have to be there.
        sessions: how many are remembered.
        session_bytes: what all of them may take.
        session_seconds: after which an unused one is forgotten.
    """

    pool: PoolLimits
    body: int = 4 * 2**20
    body_seconds: float = 20.0
    sessions: int = 1000
    session_bytes: int = 256 * 2**20
    session_seconds: float = 3600.0


def service(limits: ServiceLimits, hosts: Sequence[str], token: str | None = None) -> FastAPI:
    """The application.

    Args:
        limits: what it lets others use.
        hosts: names under which it may be asked, ports apart.
        token: what requests have to bring, or None.
    """
    pool = Pool(limits.pool)
    sessions = SessionStore(limits.sessions, limits.session_bytes, limits.session_seconds)
    metrics = Metrics(pool, sessions)

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        await pool.start()
        try:
            yield
        finally:
            await pool.stop()

    app: FastAPI = FastAPIOffline(
        title="Serendipity",
        version=__version__,
        summary="Plan help for a person who did not ask for it, and prove that none is better.",
        lifespan=lifespan,
        redoc_url=None,
        responses=REFUSALS,
        middleware=[
            Middleware(Responses, inline=True, count=metrics.count),
            Middleware(Access, hosts=hosts, token=token),
            Middleware(BodyLimits, most=limits.body, seconds=limits.body_seconds),
        ],
        exception_handlers=HANDLERS,
    )
    app.include_router(call_router(pool))
    app.include_router(session_router(pool, sessions))

    @app.get("/health", tags=["server"])
    async def health() -> dict[str, Any]:
        """Whether the server is up, and how many workers are at work."""
        return {
            "status": "ok",
            "version": __version__,
            "workers": limits.pool.workers,
            "busy": pool.figures.busy,
            "waiting": pool.figures.waiting,
        }

    @app.get("/metrics", tags=["server"], response_class=Response)
    async def figures() -> Response:
        """Figures for Prometheus."""
        return metrics.page()

    return app
