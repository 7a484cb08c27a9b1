"""The pages of one room: one that does not listen holds nobody up."""

import asyncio
import json
from typing import Any

import pytest
from fastapi import WebSocketDisconnect

from serendipity.live.play.application import _Pages
from serendipity.model import UsageError


class Room:
    def view(self) -> dict[str, Any]:
        return {}

    def do(self, message: dict[str, Any]) -> dict[str, Any]:
        if message["do"] == "refuse":
            raise UsageError("no")
        return {"kind": "answer"}


class Socket:
    """A page that says some things, and takes so many."""

    def __init__(self, says: list[str], takes: int) -> None:
        self.says = says
        self.takes = takes
        self.told: list[str] = []

    async def accept(self) -> None:
        pass

    async def receive_text(self) -> str:
        if not self.says:
            raise WebSocketDisconnect
        return json.dumps({"do": self.says.pop(0)})

    async def send_json(self, message: dict[str, Any]) -> None:
        if len(self.told) == self.takes:
            await asyncio.Event().wait()
        self.told.append(message["kind"])


@pytest.mark.parametrize("asks", ["ask", "refuse"])
def test_a_page_that_does_not_listen_holds_nobody_up(asks: str) -> None:
    async def both() -> list[str]:
        pages = _Pages(Room())  # type: ignore[arg-type]
        deaf = asyncio.create_task(pages.serve(Socket([asks], takes=1)))  # type: ignore[arg-type]
        await asyncio.sleep(0.1)
        other = Socket(["ask", "refuse", "ask"], takes=9)
        try:
            async with asyncio.timeout(5):
                await pages.serve(other)  # type: ignore[arg-type]
        finally:
            deaf.cancel()
        return other.told

    assert asyncio.run(both()) == ["view", "answer", "refused", "answer"]
