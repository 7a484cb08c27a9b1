"""The service as an ASGI application: calls that stand for themselves, and those of sessions."""

from collections.abc import AsyncIterator, Callable, Coroutine, Sequence
from contextlib import aclosing, asynccontextmanager
from dataclasses import dataclass
from typing import Annotated, Any

import prometheus_client as prometheus
from fastapi import APIRouter, FastAPI, Query, Request, Response
from fastapi_offline import FastAPIOffline
from prometheus_client.core import CounterMetricFamily
from prometheus_client.process_collector import ProcessCollector
from prometheus_client.registry import Collector
from starlette.middleware import Middleware
from starlette.responses import JSONResponse
from starlette.types import Scope

from serendipity import __version__
from serendipity_live.guards.draining import Drained, Draining
from serendipity_live.guards.middleware import Access, BodyLimits, Responses
from serendipity_live.service import answering
from serendipity_live.service import requests as asked
from serendipity_live.service.repeats import Repeats
from serendipity_live.service.sessions import Remembered, SessionStore
from serendipity_live.workers.pool import Pool, PoolLimits

Described = dict[int | str, dict[str, Any]]

WithSnapshot = Annotated[bool, Query(alias="snapshot", description="whether all of it comes, too")]


def _says(description: str, kind: str = "application/json") -> Described:
    schema = {"type": "object" if kind == "application/json" else "string"}
    return {200: {"description": description, "content": {kind: {"schema": schema}}}}


_RESULT = _says(asked.CALLS["plan"].schema)
_STREAM = _says("events `answer` with results that get better; then `end`, or `error`", "text/event-stream")


def call_router(pool: Pool) -> APIRouter:
    """The paths of calls that stand for themselves."""
    router = APIRouter(tags=["calls"])

    def said(job: str, call: asked.RequestPart) -> answering.Answers:
        return answering.answers(pool, job, call.model_dump_json().encode())

    def endpoint(job: str, kind: type[asked.RequestPart]) -> Callable[..., Coroutine[Any, Any, Response]]:
        async def answer(call: kind, request: Request) -> Response:  # type: ignore[valid-type]
            return await answering.as_json(request, said(job, call))

        return answer

    for job, call in asked.CALLS.items():
        how: dict[str, Any] = {"responses": _says(call.schema), "response_class": Response}
        path = f"/{job.replace('_', '-')}"
        router.post(path, name=job, description=call.about, **how)(endpoint(job, call.arguments))

    @router.post("/plan/anytime", responses=_STREAM, response_class=Response)
    async def plan_anytime(call: asked.AnytimeRequest, request: Request) -> Response:
        """The same with answers on the way, as server-sent events; the last one stands."""
        return await answering.as_events(request, said("plan_anytime", call))

    return router


def session_router(pool: Pool, sessions: SessionStore) -> APIRouter:
    """The paths of sessions' calls."""
    router = APIRouter(prefix="/sessions", tags=["sessions"])

    async def said(name: str, call: str, given: asked.RequestPart) -> answering.Answers:
        with sessions.calling(name) as session:
            async with aclosing(_said(pool, session, call, given.model_dump())) as bodies:
                async for body in bodies:
                    yield body

    async def moved(
        request: Request, name: str, call: str, given: asked.RequestPart, whole: bool
    ) -> dict[str, Any]:
        with sessions.calling(name) as session:
            await answering.all_of(request, _said(pool, session, call, given.model_dump()))
            return session.told(whole=whole)

    moves: dict[str, Any] = {"response_model": asked.SessionMoved, "response_model_exclude_unset": True}

    @router.post("", status_code=201, **moves)
    async def begin(
        call: asked.SessionRequest, request: Request, whole: WithSnapshot = False
    ) -> dict[str, Any]:
        """Begin a session."""
        session = sessions.begin(*call.parts())
        await answering.all_of(request, _said(pool, session, "begin", {}))
        sessions.add(session)
        return session.told(whole=whole)

    @router.get("/{name}", response_model=asked.SessionState, response_model_exclude_unset=True)
    async def state(name: str) -> dict[str, Any]:
        """Where a session stands."""
        return sessions.named(name).told()

    @router.delete("/{name}", status_code=204)
    async def end(name: str) -> None:
        """End a session."""
        sessions.end(name)

    @router.post("/{name}/plan", responses=_RESULT, response_class=Response)
    async def plan(name: str, call: asked.SessionPlanRequest, request: Request) -> Response:
        """The best answer from where the session stands."""
        return await answering.as_json(request, said(name, "plan", call))

    @router.post("/{name}/plan/anytime", responses=_STREAM, response_class=Response)
    async def plan_anytime(name: str, call: asked.SessionPlanRequest, request: Request) -> Response:
        """The same with answers on the way, as server-sent events; the last one stands."""
        return await answering.as_events(request, said(name, "plan_anytime", call))

    @router.post("/{name}/execute", **moves)
    async def execute(
        name: str, call: asked.ExecuteRequest, request: Request, whole: WithSnapshot = False
    ) -> dict[str, Any]:
        """Move on by one epoch in which these actions were executed (none: everybody waited)."""
        return await moved(request, name, "execute", call, whole)

    @router.post("/{name}/change", **moves)
    async def change(
        name: str, call: asked.ChangeRequest, request: Request, whole: WithSnapshot = False
    ) -> dict[str, Any]:
        """Set facts to true or false, as they were seen."""
        return await moved(request, name, "change", call, whole)

    @router.post("/{name}/goal", **moves)
    async def set_goal(
        name: str, call: asked.GoalRequest, request: Request, whole: WithSnapshot = False
    ) -> dict[str, Any]:
        """Give the human another goal: facts, with ``!`` in front of those to be false."""
        return await moved(request, name, "set_goal", call, whole)

    return router


def snapshot_router(sessions: SessionStore) -> APIRouter:
    """The path of what another server needs to go on with a session."""
    router = APIRouter(prefix="/sessions", tags=["sessions"])

    @router.get("/{name}/snapshot", response_model=asked.SessionSnapshot)
    async def snapshot(name: str) -> dict[str, Any]:
        """All of a session, for another server to go on with."""
        return sessions.named(name).snapshot

    return router


def _said(pool: Pool, session: Remembered, call: str, given: dict[str, Any]) -> answering.Answers:
    return answering.answers(pool, "session", session.asked(call, given), session)


@dataclass(frozen=True, slots=True)
class ServiceLimits:
    """What a service lets others use.

    Attributes:
        body: bytes of a request.
        body_seconds: until all of them have to be there.
        session_seconds: after which an unused one is forgotten.
        keys: answers that are kept for requests with an ``Idempotency-Key``.
        key_seconds: after which they are forgotten.
    """

    pool: PoolLimits
    body: int = 4 * 2**20
    body_seconds: float = 20.0
    sessions: int = 1000
    session_bytes: int = 256 * 2**20
    session_seconds: float = 3600.0
    keys: int = 1000
    key_bytes: int = 64 * 2**20
    key_seconds: float = 3600.0


def service(
    limits: ServiceLimits, hosts: Sequence[str], token: str | None = None, draining: Draining | None = None
) -> FastAPI:
    """The application."""
    drains = draining or Draining()
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
        responses=answering.REFUSALS,
        middleware=[
            Middleware(Responses, inline=True, count=metrics.count),
            Middleware(Access, hosts=hosts, token=token),
            Middleware(Drained, draining=drains),
            Middleware(BodyLimits, most=limits.body, seconds=limits.body_seconds),
            Middleware(Repeats, most=limits.keys, bytes_=limits.key_bytes, seconds=limits.key_seconds),
        ],
        exception_handlers=answering.HANDLERS,
    )
    app.include_router(call_router(pool))
    app.include_router(session_router(pool, sessions))
    app.include_router(snapshot_router(sessions))

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

    @app.get("/ready", tags=["server"], responses={503: {"model": asked.Refusal}})
    async def ready() -> Response:
        """Whether the server takes requests: not once it is about to end."""
        if drains.begun:
            return JSONResponse({"error": "the server is about to end"}, 503)
        return JSONResponse({"status": "ready"})

    @app.get("/metrics", tags=["server"], response_class=Response)
    async def figures() -> Response:
        """Figures for Prometheus."""
        return metrics.page()

    return app


_METHODS = ("GET", "POST", "DELETE", "HEAD", "OPTIONS")
"""Others can be anything, and each would be a row."""

_BUCKETS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60)


class Metrics:
    """Figures of one server, of its workers and sessions; several servers in a process do not mix."""

    def __init__(self, pool: Pool, sessions: SessionStore) -> None:
        self._registry = registry = prometheus.CollectorRegistry()
        ProcessCollector(registry=registry)
        self._requests = prometheus.Counter(
            "serendipity_requests", "Requests answered.", ["path", "method", "status"], registry=registry
        )
        self._seconds = prometheus.Histogram(
            "serendipity_request_seconds",
            "Until the answer was said.",
            ["path"],
            registry=registry,
            buckets=_BUCKETS,
        )
        figures = pool.figures
        for name, about, value in (
            ("workers", "Worker processes.", lambda: pool.limits.workers),
            ("workers_busy", "Worker processes at work.", lambda: figures.busy),
            ("queue", "Requests that wait for a worker.", lambda: figures.waiting),
            ("sessions", "Sessions that are remembered.", lambda: len(sessions)),
        ):
            prometheus.Gauge(f"serendipity_{name}", about, registry=registry).set_function(value)
        registry.register(_PoolCounters(pool))

    def count(self, scope: Scope, status: int, seconds: float) -> None:
        """Take in a request that was answered."""
        path = getattr(scope.get("route"), "path", "other")
        method = scope["method"] if scope["method"] in _METHODS else "other"
        self._requests.labels(path, method, status).inc()
        self._seconds.labels(path).observe(seconds)

    def page(self) -> Response:
        """The figures as Prometheus reads them."""
        return Response(prometheus.generate_latest(self._registry), media_type=prometheus.CONTENT_TYPE_LATEST)


class _PoolCounters(Collector):
    """What the pool counts by itself."""

    def __init__(self, pool: Pool) -> None:
        self._figures = pool.figures

    def collect(self) -> list[CounterMetricFamily]:
        """Counters as they stand."""
        refused = CounterMetricFamily("serendipity_refused", "Requests that found the queue full.")
        refused.add_metric([], self._figures.refused)
        replaced = CounterMetricFamily("serendipity_workers_replaced", "By reason.", labels=["reason"])
        for reason, count in self._figures.replaced.items():
            replaced.add_metric([reason], count)
        return [refused, replaced]
