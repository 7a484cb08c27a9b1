"""``serendipity.aio``: the same answers, awaited; whoever is cancelled has ended the search."""

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

import serendipity
import serendipity.aio
from serendipity import Result, Task
from serendipity.testing.cases import case_1
from tests.facade.conftest import ENDLESS


def test_answers_are_those_of_plain_calls() -> None:
    async def asked() -> None:
        task = case_1()
        result = await serendipity.aio.plan(task, discount=0.9)
        assert result.cost == serendipity.plan(task, discount=0.9).cost == 8.4
        assert (await serendipity.aio.verify(task, result)).verdict == "proved"
        costs = [answer.cost async for answer in serendipity.aio.plan_anytime(task, discount=0.9)]
        assert costs[-1] == 8.4
        session = serendipity.aio.Session(task, discount=0.9)
        answer = await session.plan()
        session.execute([step.action for step in answer.plan or () if step.epoch == 1])
        *_, last = [answer async for answer in session.plan_anytime()]
        assert last.opportunity and session.human_plan is not None

    asyncio.run(asked())


async def _all_of(answers: Any) -> None:
    async for _ in answers:
        pass


async def _verified(task: Task) -> None:
    result = serendipity.plan(task, time_limit=0.1, **ENDLESS)
    await serendipity.aio.verify(task, result, method="program")


CALLS: dict[str, Callable[[Task], Awaitable[object]]] = {
    "plan": lambda task: serendipity.aio.plan(task, **ENDLESS),
    "plan_anytime": lambda task: _all_of(serendipity.aio.plan_anytime(task, **ENDLESS)),
    "verify": _verified,
    "Session": lambda task: serendipity.aio.Session(task, **ENDLESS).plan(),
}


@pytest.mark.long
@pytest.mark.parametrize("call", CALLS)
def test_cancelling_ends_the_search(endless: Task, call: str) -> None:
    async def cancelled() -> float:
        asked = asyncio.ensure_future(CALLS[call](endless))
        await asyncio.sleep(0.5)
        assert not asked.done(), "it takes long"
        begun, busy = time.perf_counter(), time.process_time()
        asked.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asked
        taken = min(time.perf_counter() - begun, 10 * (time.process_time() - busy) + 0.05)
        spent = time.process_time()
        await asyncio.sleep(0.2)
        assert time.process_time() - spent < 0.1, "nobody searches on"
        return taken

    assert asyncio.run(cancelled()) < 0.5


def test_who_is_cancelled_again_still_waits_for_the_thread() -> None:
    begun, over = threading.Event(), threading.Event()

    def dawdle(_: Result) -> None:
        begun.set()
        time.sleep(0.3)
        over.set()

    async def cancelled() -> None:
        asked = asyncio.ensure_future(serendipity.aio.plan(case_1(), on_improvement=dawdle))
        await asyncio.to_thread(begun.wait, 10)
        for _ in range(3):
            asked.cancel()
            await asyncio.sleep(0.02)
        with pytest.raises(asyncio.CancelledError):
            await asked
        assert over.is_set()

    asyncio.run(cancelled())
