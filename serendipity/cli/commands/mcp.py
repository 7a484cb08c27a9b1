"""``serendipity mcp``: the planner as tools of agents that talk."""

from typing import Annotated

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import serving
from serendipity.cli.streams import output
from serendipity.cli.streams.manner import is_quiet
from serendipity.model import UsageError


def mcp(
    *,
    http: Annotated[bool, option("--http", "Over HTTP, instead of stdin and stdout.")] = False,
    at: serving.Listening,
    limits: serving.Serving,
) -> int:
    """Tools for agents that talk (Model Context Protocol). It needs serendipity-planner[mcp]."""
    try:
        from serendipity_live.guards import connections
        from serendipity_live.mcp import transports
    except ImportError as missing:
        raise UsageError(f"mcp: needs {missing.name}: install serendipity-planner[mcp]") from None
    if not http:
        transports.over_streams(limits.pool(), limits.body())
        return ExitCode.ANSWERED
    token = at.token()
    allowed = limits.pool(), limits.body()
    listener = connections.listening(at.host, at.port)
    app = transports.over_http(*allowed, connections.hosts(at.host, at.allow_host or ()), token)
    if not is_quiet():
        output.say(f"Serving on {connections.url(listener)}{transports.PATH}; Ctrl-C stops it.\n")
    connections.serve(app, listener)
    return ExitCode.ANSWERED
