"""How agents reach the tools: over the standard streams of a process, or over HTTP."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager

from mcp.server.stdio import stdio_server
from mcp.server.transport_security import TransportSecuritySettings
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.routing import Mount

from serendipity_live.guards.middleware import Access
from serendipity_live.mcp.tools import agent_server
from serendipity_live.workers.pool import Pool, PoolLimits

PATH = "/mcp"
"""Where tools are reached over HTTP."""


def over_streams(limits: PoolLimits, body_limit: int) -> None:
    """Answer on the standard streams until stdin ends."""
    asyncio.run(_over_streams(limits, body_limit))


async def _over_streams(limits: PoolLimits, body_limit: int) -> None:
    async with _at_work(limits) as pool, stdio_server() as (read, write):
        server = agent_server(pool, body_limit)
        await server.run(read, write, server.create_initialization_options())


def over_http(limits: PoolLimits, body_limit: int, hosts: Sequence[str], token: str | None) -> Starlette:
    """An application that answers under :data:`PATH`; each call stands for itself."""
    pool = Pool(limits)
    tools = agent_server(pool, body_limit).streamable_http_app(
        streamable_http_path=PATH,
        json_response=True,
        stateless_http=True,
        max_request_body_size=body_limit,
        transport_security=TransportSecuritySettings(enable_dns_rebinding_protection=False),  # see Access
    )

    @asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        async with tools.router.lifespan_context(tools):
            await pool.start()
            try:
                yield
            finally:
                await pool.stop()

    return Starlette(
        routes=[Mount("/", tools)],
        middleware=[Middleware(Access, hosts=hosts, token=token)],
        lifespan=lifespan,
    )


@asynccontextmanager
async def _at_work(limits: PoolLimits) -> AsyncIterator[Pool]:
    pool = Pool(limits)
    await pool.start()
    try:
        yield pool
    finally:
        await pool.stop()
