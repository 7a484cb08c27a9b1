"""``serendipity serve``: the HTTP service."""

import os
from pathlib import Path
from typing import Annotated, Final

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.reading import read_text
from serendipity.cli.streams import output
from serendipity.cli.streams.manner import is_quiet
from serendipity.model import UsageError
from serendipity.model.options import limit_of

_TOKEN: Final = "SERENDIPITY_TOKEN"
_MIB: Final = 2**20


def serve(
    host: Annotated[str, option("--host ADDRESS", "Where to listen.")] = "127.0.0.1",
    port: Annotated[int, option("--port N", "0 for any that is free.")] = 8123,
    allow_host: Annotated[
        list[str] | None, option("--allow-host NAME", "Another name under which it may be asked.")
    ] = None,
    token_file: Annotated[
        Path | None, option("--token-file FILE", f"A token that requests need; or in {_TOKEN}.")
    ] = None,
    workers: Annotated[
        int | None, option("--workers N", "Processes; by default as many as processors.")
    ] = None,
    queue: Annotated[int, option("--queue N", "Requests that may wait.")] = 64,
    body_limit: Annotated[str, option("--body-limit MIB", "The most that a request may have.")] = "4",
    time_limit: Annotated[str, option("--time-limit SECONDS", "The most that a request may take.")] = "60",
    memory_limit: Annotated[str, option("--memory-limit MIB", "The most that a process may use.")] = "2000",
) -> int:
    """Answer requests over HTTP: plan, verify, sessions. It needs serendipity-planner[live]."""
    for name, number, least in (("--workers", workers, 1), ("--queue", queue, 0)):
        if number is not None and number < least:
            raise UsageError(f"{name}: expected at least {least}, got {number}")
    try:
        from serendipity.live.guards import connections
        from serendipity.live.service.application import ServiceLimits, service
        from serendipity.live.workers.pool import PoolLimits
    except ImportError as missing:
        raise UsageError(f"serve: needs {missing.name}: install serendipity-planner[live]") from None
    token = _token(token_file)
    if token is None and not connections.loopback(host):
        raise UsageError(f"--host: others can reach {host}, so a token is needed: --token-file, or {_TOKEN}")
    pool = PoolLimits(
        workers or os.cpu_count() or 1,
        queue,
        _limit("time_limit", time_limit, "seconds"),
        _limit("memory_limit", memory_limit, "MiB"),
    )
    limits = ServiceLimits(pool, int(_limit("body_limit", body_limit, "MiB") * _MIB))
    listener = connections.listening(host, port)
    app = service(limits, connections.hosts(host, allow_host or ()), token)
    if not is_quiet():
        output.say(f"Serving on {connections.url(listener)}, described at /docs; Ctrl-C stops it.\n")
    connections.serve(app, listener)
    return ExitCode.ANSWERED


def _limit(name: str, value: str, unit: str) -> float:
    limit = limit_of(name, value, unit)
    if limit == float("inf"):
        raise UsageError(f"{name}: expected {unit}, got {value}")
    return limit


def _token(file: Path | None) -> str | None:
    token = os.environ.get(_TOKEN) if file is None else read_text(file)
    if token is None:
        return None
    token = token.strip()
    if not token or not token.isascii() or not token.isprintable():
        where = _TOKEN if file is None else str(file)
        raise UsageError(f"{where}: expected a token of visible characters")
    return token
