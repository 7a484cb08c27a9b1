"""The workers of a server: who is free, who waits for one, and what becomes of those that fail."""

import asyncio
from collections.abc import AsyncGenerator, AsyncIterator, Coroutine
from contextlib import aclosing, asynccontextmanager
from dataclasses import dataclass, field
from typing import Final

from search.kernel.library import library
from serendipity_live.workers.handle import Handle
from serendipity_live.workers.messages import Message

_OVERTIME: Final = 5.0
"""Seconds that a worker may take longer than its job's time limit, which it keeps by itself."""

_GRACE: Final = 1.0
"""Seconds in which a worker has to leave a job that nobody waits for any more."""

_FULL: Final = 0.5
"""Share of the memory limit that a worker may keep between jobs."""

_ATTEMPTS: Final = 2
"""How many workers may be lost over one job: it may not have been its fault."""


class BusyError(Exception):
    """Every worker is at work, and as many wait for one as may."""


class LostError(Exception):
    """A worker was killed, or had to be."""


@dataclass(frozen=True, slots=True)
class PoolLimits:
    """What a pool may use: seconds for a job, MiB for a process."""

    workers: int
    queue: int
    time_limit: float
    memory_limit: float


@dataclass(slots=True)
class PoolFigures:
    """What has happened so far; workers that were replaced are counted by reason."""

    waiting: int = 0
    busy: int = 0
    refused: int = 0
    replaced: dict[str, int] = field(default_factory=dict)


class Pool:
    """Worker processes, each on one job at a time."""

    def __init__(self, limits: PoolLimits) -> None:
        self.limits = limits
        self.figures = PoolFigures()
        self._free = asyncio.Semaphore(limits.workers)
        self._idle: list[Handle] = []
        self._all: set[Handle] = set()
        self._chores: set[asyncio.Task[None]] = set()
        self._stopped = False

    async def start(self) -> None:
        """Start all workers."""
        library()  # says once if there is none, and not once for each process
        for _ in range(self.limits.workers):
            self._idle.append(await self._started())

    async def stop(self) -> None:
        """End all workers."""
        self._stopped = True
        for chore in self._chores:
            chore.cancel()
        await asyncio.gather(*self._chores, return_exceptions=True)
        await asyncio.gather(*(worker.kill() for worker in self._all))

    async def run(self, job: str, body: bytes) -> AsyncGenerator[Message, None]:
        """The answers to a job, and what ended it: a frame ``end`` or ``error``.

        A job whose worker is lost before its first answer is given to another one.

        Raises:
            BusyError: there is no room for it now.
            LostError: its worker was killed.
        """
        lost = 0
        for _ in range(self.limits.workers + _ATTEMPTS):
            begun = said = False
            try:
                async with aclosing(self._attempt(job, body)) as frames:
                    async for frame in frames:
                        if frame.head["kind"] == "begun":
                            begun = True
                        else:
                            said = True
                            yield frame
                return
            except EOFError:
                lost += begun  # one that was killed before has nothing to do with the job
                if said or lost == _ATTEMPTS:
                    break
        raise LostError("the worker process of this request was killed: try again")

    async def _attempt(self, job: str, body: bytes) -> AsyncGenerator[Message, None]:
        async with self._worker() as worker:
            await worker.give(job, body, self.limits.time_limit)
            end = asyncio.get_running_loop().time() + self.limits.time_limit + _OVERTIME
            while worker.working:
                try:
                    async with asyncio.timeout_at(end):
                        frame = await worker.hear()
                except TimeoutError:
                    raise LostError("the time limit came first, and the worker was replaced") from None
                yield frame

    @asynccontextmanager
    async def _worker(self) -> AsyncIterator[Handle]:
        if self._free.locked() and self.figures.waiting >= self.limits.queue:
            self.figures.refused += 1
            raise BusyError
        self.figures.waiting += 1
        try:
            await self._free.acquire()
        finally:
            self.figures.waiting -= 1
        worker = self._idle.pop()
        self.figures.busy += 1
        try:
            if worker.ended:
                worker = await self._fit(worker)
            yield worker
        except EOFError:
            await worker.wait()  # who was killed with it is known then, too
            raise
        finally:
            if not self._stopped:
                self._later(self._take_back(worker))

    async def _take_back(self, worker: Handle) -> None:
        """Have a worker free again, or another one in its place."""
        try:
            if worker.working:
                await worker.leave(_GRACE)
            self._idle.append(await self._fit(worker))
        finally:
            self.figures.busy -= 1
            self._free.release()

    async def _fit(self, worker: Handle) -> Handle:
        if worker.working or worker.ended:
            reason = "killed" if worker.ended else "stuck"
        elif worker.resident > _FULL * self.limits.memory_limit * 2**20:
            reason = "memory"
        else:
            return worker
        await worker.kill()
        self._all.discard(worker)
        self.figures.replaced[reason] = self.figures.replaced.get(reason, 0) + 1
        return await self._started()

    async def _started(self) -> Handle:
        worker = await Handle.start(self.limits.memory_limit)
        self._all.add(worker)
        self._later(self._watch(worker))
        return worker

    async def _watch(self, worker: Handle) -> None:
        """Replace a worker that ends while it is free."""
        await worker.wait()
        if worker in self._idle:
            fit = await self._fit(worker)  # meanwhile somebody may have been given the one that has ended
            if worker in self._idle:
                self._idle[self._idle.index(worker)] = fit
            else:
                await fit.kill()
                self._all.discard(fit)

    def _later(self, chore: Coroutine[None, None, None]) -> None:
        task = asyncio.create_task(chore)
        self._chores.add(task)
        task.add_done_callback(self._chores.discard)
