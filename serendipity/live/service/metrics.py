"""What a server has done so far, for Prometheus."""

from prometheus_client import (
    CONTENT_TYPE_LATEST,
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    generate_latest,
)
from prometheus_client.core import CounterMetricFamily
from prometheus_client.process_collector import ProcessCollector
from prometheus_client.registry import Collector
from starlette.responses import Response
from starlette.types import Scope

from serendipity.live.service.sessions import SessionStore
from serendipity.live.workers.pool import Pool

_METHODS = ("GET", "POST", "DELETE", "HEAD", "OPTIONS")
"""Others can be anything, and each would be a row."""

_BUCKETS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60)


class Metrics:
    """Figures of one server, of its workers and sessions; several servers in a process do not mix."""

    def __init__(self, pool: Pool, sessions: SessionStore) -> None:
        self._registry = registry = CollectorRegistry()
        ProcessCollector(registry=registry)
        self._requests = Counter(
            "serendipity_requests", "Requests answered.", ["path", "method", "status"], registry=registry
        )
        self._seconds = Histogram(
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
            Gauge(f"serendipity_{name}", about, registry=registry).set_function(value)
        registry.register(_PoolCounters(pool))

    def count(self, scope: Scope, status: int, seconds: float) -> None:
        """Take in a request that was answered."""
        path = getattr(scope.get("route"), "path", "other")
        method = scope["method"] if scope["method"] in _METHODS else "other"
        self._requests.labels(path, method, status).inc()
        self._seconds.labels(path).observe(seconds)

    def page(self) -> Response:
        """The figures as Prometheus reads them."""
        return Response(generate_latest(self._registry), media_type=CONTENT_TYPE_LATEST)


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
