"""What docs/execution.md promises of threads, processes, pickling and cancellation."""

import multiprocessing
import pickle
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from typing import Any

import pytest

import serendipity
from serendipity import Session, Task
from serendipity.testing.cases import case_1, case_2
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
