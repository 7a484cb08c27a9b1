"""The page as an ASGI application: a websocket for each room, and files; nothing comes from elsewhere."""

import asyncio
import json
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any, Final, Protocol

from fastapi import FastAPI, Response, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse, PlainTextResponse
from starlette.middleware import Middleware

from serendipity.model import SerendipityError
from serendipity_live.guards.middleware import Access, BodyLimits, Responses
from serendipity_live.play.language import script
from serendipity_live.play.records import Download

_TYPES: Final = {"js": "text/javascript", "css": "text/css"}
_PARTS: Final = ("play.js", "study.js", "map.js", "play.css")
_FRESH: Final = {"Cache-Control": "no-store"}
_KIB: Final = 1024
_PATIENCE: Final = 5.0
"""Seconds that a page has to take what it is told."""


class Room(Protocol):
    """What some pages show together."""

    def view(self) -> dict[str, Any]:
        """What pages show."""

    def do(self, message: dict[str, Any]) -> dict[str, Any] | None:
        """What a page asks for; an answer for it alone, or None where all of the room are to be told."""


class Host(Protocol):
    """What is behind the pages: :class:`.rounds.SharedRounds`, or a study."""

    @property
    def texts(self) -> Mapping[str, str]:
        """Of the page, by the English ones, in another language."""

    def room(self, token: str) -> Room | None:
        """The room of a token; that of the first page where it is empty."""

    def file(self, path: str) -> Download | None:
        """What there is at another address."""


def application(host: Host, hosts: Sequence[str]) -> FastAPI:
    """The application."""
    app = FastAPI(
        openapi_url=None,
        middleware=[
            Middleware(Responses, inline=False),
            Middleware(Access, hosts=hosts),
            Middleware(BodyLimits, most=64 * _KIB, seconds=10.0),
        ],
    )
    pages: dict[str, _Pages] = {}

    @app.get("/")
    @app.get("/s/{token}")
    async def page(token: str = "") -> Response:
        if host.room(token) is None:
            return PlainTextResponse(
                "There is nobody with this link. Please look whether it is complete.", 404
            )
        return HTMLResponse(_text("play.html"), headers=_FRESH)

    @app.get("/page/{name}")
    async def part(name: str) -> Response:
        if name == "texts.js":
            return Response(script(host.texts), media_type=_TYPES["js"], headers=_FRESH)
        if name not in _PARTS:
            return Response(status_code=404)
        return Response(_text(name), media_type=_TYPES[name.rpartition(".")[2]], headers=_FRESH)

    @app.get("/{path:path}")
    async def file(path: str) -> Response:
        found = await asyncio.to_thread(host.file, path)
        if found is None:
            return Response(status_code=404)
        saved = {} if found.name is None else {"Content-Disposition": f'attachment; filename="{found.name}"'}
        return Response(found.text, media_type=found.kind, headers=_FRESH | saved)

    @app.websocket("/live")
    @app.websocket("/live/{token}")
    async def live(socket: WebSocket, token: str = "") -> None:
        room = host.room(token)
        if room is None:
            await socket.close(1008)
            return
        await pages.setdefault(token, _Pages(room)).serve(socket)

    return app


async def _heard(socket: WebSocket) -> str:
    """What a page says next; empty where that is no text."""
    try:
        return await socket.receive_text()
    except KeyError:
        return ""


class _Pages:
    """The pages of a room that are open: what one of them does, all of them show."""

    def __init__(self, room: Room) -> None:
        self._room = room
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
                await self._hear(socket, await _heard(socket))
        except WebSocketDisconnect:
            pass
        finally:
            self._open.discard(socket)

    async def _hear(self, socket: WebSocket, text: str) -> None:
        message = _message(text)
        answer = _refused("expected a JSON object") if message is None else await self._done(message)
        if answer:
            await socket.send_json(answer)

    async def _done(self, message: dict[str, Any]) -> dict[str, Any] | None:
        """Do what a page asks for; the answer for it alone, or None where all have been told."""
        async with self._turn:
            try:
                answer = await asyncio.to_thread(self._room.do, message)
            except SerendipityError as error:
                return _refused(str(error))
            if answer is None:
                view = await self._view()
                await asyncio.gather(*(self._tell(page, view) for page in list(self._open)))
            return answer

    async def _tell(self, page: WebSocket, view: dict[str, Any]) -> None:
        """Have a page show something; one that does not take it in time is not waited for."""
        try:
            async with asyncio.timeout(_PATIENCE):
                await page.send_json(view)
        except (WebSocketDisconnect, RuntimeError, TimeoutError):
            self._open.discard(page)

    async def _view(self) -> dict[str, Any]:
        return {"kind": "view", **await asyncio.to_thread(self._room.view)}


def _refused(why: str) -> dict[str, Any]:
    return {"kind": "refused", "error": why}


def _message(text: str) -> dict[str, Any] | None:
    """What a page says, halves of characters replaced, since no file takes them; None: no object."""
    try:
        whole = json.dumps(json.loads(text), ensure_ascii=False).encode(errors="replace")
        message = json.loads(whole)
    except (ValueError, RecursionError):
        return None
    return message if isinstance(message, dict) else None


def _text(name: str) -> str:
    return files("serendipity_live.play").joinpath("page", name).read_text(encoding="utf-8")
