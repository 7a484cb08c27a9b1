"""The page as an ASGI application: one websocket, and exports; nothing leaves the machine."""

import asyncio
import json
from collections.abc import Sequence
from importlib.resources import files
from typing import Any, Final, Protocol

from fastapi import FastAPI, Response, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse
from starlette.middleware import Middleware

from serendipity.live.guards.access import Access
from serendipity.live.guards.bodies import BodyLimits
from serendipity.live.guards.headers import Headed
from serendipity.live.play.records import Event, as_csv
from serendipity.model import SerendipityError

_TYPES: Final = {"play.js": "text/javascript", "map.js": "text/javascript", "play.css": "text/css"}
_KIB: Final = 1024
_PATIENCE: Final = 5.0
"""Seconds that a page has to take what it is told."""


class Host(Protocol):
    """What is behind the page: :class:`.table.Table`, or a study."""

    def view(self) -> dict[str, Any]:
        """What pages show."""

    def do(self, message: dict[str, Any]) -> dict[str, Any] | None:
        """What a page asks for; an answer for it alone, or None where all pages are to be told."""

    def events(self) -> list[Event]:
        """All that has happened."""


def application(host: Host, hosts: Sequence[str]) -> FastAPI:
    """The application.

    Args:
        host: what is behind the page.
        hosts: names under which it may be asked, ports apart.
    """
    app = FastAPI(
        openapi_url=None,
        middleware=[
            Middleware(Headed, inline=False),
            Middleware(Access, hosts=hosts),
            Middleware(BodyLimits, most=64 * _KIB, seconds=10.0),
        ],
    )
    pages = _Pages(host)

    @app.get("/")
    async def page() -> HTMLResponse:
        return HTMLResponse(_text("play.html"), headers={"Cache-Control": "no-cache"})

    @app.get("/page/{name}")
    async def part(name: str) -> Response:
        if name not in _TYPES:
            return Response(status_code=404)
        return Response(_text(name), media_type=_TYPES[name], headers={"Cache-Control": "no-cache"})

    @app.get("/export.json")
    async def as_json() -> Response:
        text = json.dumps(host.events(), ensure_ascii=False, indent=1)
        return _download(text, "application/json", "serendipity.json")

    @app.get("/export.csv")
    async def as_table() -> Response:
        return _download(as_csv(host.events()), "text/csv; charset=utf-8", "serendipity.csv")

    @app.websocket("/live")
    async def live(socket: WebSocket) -> None:
        await pages.serve(socket)

    return app


class _Pages:
    """The pages that are open: what one of them does, all of them show."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self._open: set[WebSocket] = set()
        self._turn = asyncio.Lock()

    async def serve(self, socket: WebSocket) -> None:
        """Talk to a page until it closes."""
        await socket.accept()
        try:
            async with self._turn:
                await socket.send_json(await self._view())
                self._open.add(socket)
            while True:
                await self._hear(socket, await socket.receive_text())
        except WebSocketDisconnect:
            pass
        finally:
            self._open.discard(socket)

    async def _hear(self, socket: WebSocket, text: str) -> None:
        try:
            message = json.loads(text)
        except (ValueError, RecursionError):
            message = None
        if not isinstance(message, dict):
            await socket.send_json({"kind": "refused", "error": "expected a JSON object"})
            return
        async with self._turn:
            try:
                answer = await asyncio.to_thread(self._host.do, message)
            except SerendipityError as error:
                await socket.send_json({"kind": "refused", "error": str(error)})
                return
            if answer is None:
                view = await self._view()
                await asyncio.gather(*(self._tell(page, view) for page in list(self._open)))
            elif answer:
                await socket.send_json(answer)

    async def _tell(self, page: WebSocket, view: dict[str, Any]) -> None:
        """Have a page show something; one that does not take it in time is not waited for."""
        try:
            async with asyncio.timeout(_PATIENCE):
                await page.send_json(view)
        except (WebSocketDisconnect, RuntimeError, TimeoutError):
            self._open.discard(page)

    async def _view(self) -> dict[str, Any]:
        return {"kind": "view", **await asyncio.to_thread(self._host.view)}


def _text(name: str) -> str:
    return files("serendipity.live.play").joinpath("page", name).read_text(encoding="utf-8")


def _download(text: str, kind: str, name: str) -> Response:
    return Response(text, media_type=kind, headers={"Content-Disposition": f'attachment; filename="{name}"'})
