"""Calls about one task again find what earlier ones have found; what is held is bounded."""

from dataclasses import replace

import pytest

import serendipity
from search import prepare
from search.packed.packed_task import PackedTask
from serendipity import Session, Task
from serendipity.facade.prepared import HELD, LastPrepared
from serendipity.testing.cases import case_1


def copies(count: int) -> list[Task]:
    """Tasks that are equal, and not the same."""
    return [replace(case_1()) for _ in range(count)]


def test_one_task_is_prepared_once() -> None:
    held, (task, other) = LastPrepared(4, 10**6), copies(2)
    assert held.of(task) is held.of(task)
    assert held.of(other) is not held.of(task)
    assert held.of(other).task is other


def test_what_was_prepared_elsewhere_is_held() -> None:
    held, (task,) = LastPrepared(4, 10**6), copies(1)
    first, prepared = held.of(task), prepare(task)
    held.hold(prepared)
    assert held.of(task) is prepared is not first


def test_who_was_asked_for_longest_ago_goes_first() -> None:
    held, (a, b, c) = LastPrepared(2, 10**6), copies(3)
    of_a, of_b = held.of(a), held.of(b)
    assert held.of(a) is of_a
    held.of(c)
    assert held.of(a) is of_a
    assert held.of(b) is not of_b


def test_large_tasks_make_room_and_the_last_one_stays() -> None:
    size = len(case_1().actions)
    held, (a, b, c) = LastPrepared(9, 2 * size), copies(3)
    of_a, of_b, of_c = held.of(a), held.of(b), held.of(c)
    assert (held.of(c), held.of(b)) == (of_c, of_b)
    assert held.of(a) is not of_a
    small = LastPrepared(9, size - 1)
    assert small.of(a) is small.of(a)


def test_a_second_call_packs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    task = case_1()
    first = serendipity.plan(task, discount=0.9)
    session = Session(task, discount=0.9)

    def init(*_: object) -> None:
        raise AssertionError("packed again")

    monkeypatch.setattr(PackedTask, "__init__", init)
    again, of_session = serendipity.plan(task, discount=0.9), session.plan()
    assert again.plan == first.plan == of_session.plan
    assert HELD.of(task).task is task
