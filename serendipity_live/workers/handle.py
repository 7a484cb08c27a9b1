"""A worker process, as the server holds it."""

import asyncio
import os
import shutil
import signal
import sys
from asyncio.subprocess import PIPE, Process
from contextlib import suppress
from tempfile import mkdtemp
from typing import Final

from serendipity_live.workers.messages import Message

_LONGEST: Final = 2**30
"""Bytes of a message, at most."""


class Handle:
    """One process on one job at a time, made by :meth:`start`; ``resident`` bytes are left after the last."""

    def __init__(self, process: Process, folder: str) -> None:
        self._process = process
        self._folder = folder
        self.working = False
        self.resident = 0

    @classmethod
    async def start(cls, memory_limit: float) -> "Handle":
        """Start a process: in a session of its own, so that Ctrl-C in a terminal is left to the server."""
        folder = mkdtemp(prefix="serendipity-worker-")
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "serendipity_live.workers.process", str(memory_limit), folder),
            stdin=PIPE,
            stdout=PIPE,
            start_new_session=True,
            limit=_LONGEST,
        )
        return cls(process, folder)

    @property
    def pid(self) -> int:
        """The process."""
        return self._process.pid

    @property
    def ended(self) -> bool:
        """Whether the process is no more."""
        return self._process.returncode is not None

    async def give(self, job: str, body: bytes, time_limit: float) -> None:
        """Have it begin a job, unless it was killed (EOFError)."""
        self.working = True
        await self._say(Message({"kind": "job", "job": job, "time_limit": time_limit}, body))

    async def hear(self) -> Message:
        """What it says next about its job, unless it was killed (EOFError)."""
        assert self._process.stdout is not None
        frame = Message.decoded(await self._process.stdout.readline())
        if frame.head["kind"] in ("end", "error"):
            self.working = False
            self.resident = frame.head["resident"]
        return frame

    async def leave(self, grace: float) -> None:
        """Have it leave its job; it is still working afterwards where it does not, or is killed."""
        with suppress(EOFError, TimeoutError):
            await self._say(Message({"kind": "cancel"}))
            async with asyncio.timeout(grace):
                while self.working:
                    await self.hear()

    async def kill(self) -> None:
        """End it, and the solvers that it has started."""
        with suppress(ProcessLookupError, PermissionError):
            if hasattr(os, "killpg"):
                os.killpg(self.pid, signal.SIGKILL)
            else:
                self._process.kill()
        await self.wait()

    async def wait(self) -> None:
        """Return when it has ended; what it had in its temporary folder is gone with it."""
        await self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    async def _say(self, frame: Message) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(frame.encoded)
            await self._process.stdin.drain()
        except OSError:
            raise EOFError from None
