"""What docs/execution.md promises of threads, processes, pickling, cancellation and ``serendipity.aio``."""

import asyncio
import multiprocessing
import pickle
import sys
import threading
import time
from collections.abc import Awaitable, Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from typing import Any

import pytest

import serendipity
import serendipity.aio
from serendipity import Deadline, Result, Session, Task, UsageError
from serendipity_testing.cases import case_1, case_2
from tests.facade.conftest import ENDLESS

OPTIONS: list[dict[str, Any]] = [
    {"discount": "0.9"},
    {"discount": "0.5", "window_weight": 0},
    {"discount": "0.9", "mode": "communication"},
    {"discount": "0.9", "mode": "composite", "horizon": "inf"},
    {"mode": "assistance"},
]


def _cost(task: Task, options: dict[str, Any]) -> float | None:
    return serendipity.plan(task, **options).cost


def test_calls_on_one_task_may_run_in_any_threads_at_once() -> None:
    task = case_1()
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(partial(_cost, task), OPTIONS * 4))
    assert found == [_cost(case_1(), options) for options in OPTIONS] * 4


@pytest.mark.long
def test_the_kernel_is_asked_by_one_thread_at_a_time() -> None:
    task = serendipity.example("taxis")
    sure = serendipity.plan(task, mode="individual").cost
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(6) as threads:
            calls = [threads.submit(_cost, task, {"mode": "individual"}) for _ in range(200)]
            calls += [
                threads.submit(lambda: Session(task, mode="individual").plan().cost) for _ in range(200)
            ]
            assert {call.result() for call in calls} == {sure}
    finally:
        sys.setswitchinterval(interval)


def test_sessions_in_several_threads_keep_to_themselves() -> None:
    task = case_1()

    def executed(discount: str) -> list[float | None]:
        session, costs = Session(task, discount=discount), []
        while (answer := session.plan()).plan:
            costs.append(answer.cost)
            session.execute([step.action for step in answer.plan if step.epoch == 1])
        return costs

    discounts = ["0", "0.6", "0.9"]
    with ThreadPoolExecutor(3) as threads:
        assert list(threads.map(executed, discounts)) == [executed(discount) for discount in discounts]


@pytest.mark.long
@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_processes_of_every_kind_answer_the_same(method: str) -> None:
    task = case_1()
    expected = [_cost(task, options) for options in OPTIONS[:2]]  # what a fork takes along is in use here
    context = multiprocessing.get_context(method)
    with ProcessPoolExecutor(2, mp_context=context) as processes:
        assert list(processes.map(partial(_cost, task), OPTIONS[:2])) == expected


def test_values_are_pickled_and_sessions_stay_where_they_are() -> None:
    task = case_1()
    result = serendipity.plan(task, discount="0.9")
    certificate = serendipity.verify(task, result)
    values = [task, result, certificate, serendipity.simulate(task, result), result.options]
    for value in values:
        again = pickle.loads(pickle.dumps(value))
        assert type(again) is type(value) and str(again) == str(value)
    there = pickle.loads(pickle.dumps((task, result)))
    assert serendipity.verify(*there).verdict == "proved"
    session = Session(task, discount="0.9")
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(session)
    assert Session(pickle.loads(pickle.dumps(session.task)), discount="0.9").plan().cost == result.cost


def test_cancel_ends_a_call_of_another_thread_with_the_best_answer_so_far(endless: Task) -> None:
    session = Session(endless, **ENDLESS)
    timer = threading.Timer(0.5, session.cancel)
    timer.start()
    begun = time.perf_counter()
    answer = session.plan()
    assert answer.status == "feasible" and answer.cost is not None
    assert time.perf_counter() - begun < 2
    assert serendipity.check(session.task, answer).refuted is None
    timer.join()


def test_one_event_may_end_several_calls(endless: Task) -> None:
    cancelled = threading.Event()
    asked = {**ENDLESS, "cancelled": cancelled}
    with ThreadPoolExecutor(2) as threads:
        calls = [threads.submit(serendipity.plan, endless, **asked) for _ in range(2)]
        threads.submit(time.sleep, 0)
        time.sleep(0.5)
        cancelled.set()
        assert {call.result(timeout=5).status for call in calls} <= {"feasible", "unknown"}


def test_a_call_that_an_exception_leaves_keeps_nothing_locked() -> None:
    def stop(_: object) -> None:
        raise KeyboardInterrupt

    session = Session(case_2(), discount="0.5", window_weight=0)
    with pytest.raises(KeyboardInterrupt):
        session.plan(on_improvement=stop)
    assert session.plan().status == "optimal"


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


def test_a_session_that_is_awaited_is_written_down_and_restored() -> None:
    async def asked() -> None:
        task = case_1()
        session = serendipity.aio.Session(task, discount=0.9)
        answer = await session.plan()
        asking = asyncio.ensure_future(session.plan(discount=0.8))
        await asyncio.sleep(0)
        with pytest.raises(UsageError, match="session: a call is under way"):
            session.snapshot()
        await asking
        snapshot = session.snapshot()
        for kind in (serendipity.aio.Session, Session):
            assert kind.restore(task, snapshot).snapshot() == snapshot
        restored = serendipity.aio.Session.restore(task, snapshot, deadline=Deadline(60))
        again = await restored.plan()
        assert (again.plan, again.statistics["expanded"]) == (answer.plan, 0)

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
