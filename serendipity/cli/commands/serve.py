"""``serendipity serve``: the HTTP service."""

from typing import Annotated

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import serving
from serendipity.cli.streams import output
from serendipity.cli.streams.manner import is_quiet
from serendipity.model import UsageError


def serve(
    *,
    at: serving.Listening,
    limits: serving.Serving,
    drain: Annotated[
        str, option("--drain SECONDS", "That requests have to end in when SIGTERM comes.")
    ] = "30",
) -> int:
    """Answer requests over HTTP: plan, verify, sessions. It needs serendipity-planner[live]."""
    try:
        from serendipity_live.guards import connections
        from serendipity_live.guards.draining import Draining
        from serendipity_live.service.application import ServiceLimits, service

        pool = limits.pool()
    except ImportError as missing:
        raise UsageError(f"serve: needs {missing.name}: install serendipity-planner[live]") from None
    token = at.token()
    allowed, draining = ServiceLimits(pool, limits.body()), Draining()
    seconds = serving.limit("drain", drain, "seconds")
    listener = connections.listening(at.host, at.port)
    app = service(allowed, connections.hosts(at.host, at.allow_host or ()), token, draining)
    if not is_quiet():
        output.say(f"Serving on {connections.url(listener)}, described at /docs; Ctrl-C stops it.\n")
    connections.serve(app, listener, draining, seconds)
    return ExitCode.ANSWERED
