"""A task is prepared when it is loaded, and held for calls about it to come; what is held is bounded."""

from dataclasses import replace

import pytest

import serendipity
from search import PreparedTask, prepare
from search.packed.packed_task import PackedTask
from serendipity import Session, Task, pddl
from serendipity.facade.prepared import HELD, LastPrepared
from serendipity_testing.cases import case_1


def copies(count: int) -> list[Task]:
    """Tasks that are equal, and not the same."""
    return [replace(case_1()) for _ in range(count)]


def used(held: LastPrepared, task: Task) -> PreparedTask:
    """What a call uses."""
    with held.taken(task) as prepared:
        return prepared


def test_one_task_is_prepared_once() -> None:
    held, (task, other) = LastPrepared(4, 10**6), copies(2)
    assert used(held, task) is used(held, task)
    assert used(held, other) is not used(held, task)
    assert used(held, other).task is other


def test_no_two_calls_use_one_at_once() -> None:
    held, (task,) = LastPrepared(4, 10**6), copies(1)
    with held.taken(task) as first, held.taken(task) as second:
        assert first is not second
    assert used(held, task) is first, "the last one put back"


def test_a_session_shares_its_own_with_nobody_until_it_is_gone() -> None:
    (task,) = copies(1)
    first = used(HELD, task)
    session, other = Session(task), Session(task)
    assert session._prepared is first
    assert used(HELD, task) not in (first, other._prepared)
    del session
    assert used(HELD, task) is first


def test_what_was_prepared_elsewhere_is_held() -> None:
    held, (task,) = LastPrepared(4, 10**6), copies(1)
    first, prepared = used(held, task), prepare(task)
    held.hold(prepared)
    assert used(held, task) is prepared is not first


def test_who_was_asked_for_longest_ago_goes_first() -> None:
    held, (a, b, c) = LastPrepared(2, 10**6), copies(3)
    of_a, of_b = used(held, a), used(held, b)
    assert used(held, a) is of_a
    used(held, c)
    assert used(held, a) is of_a
    assert used(held, b) is not of_b


def test_large_tasks_make_room_and_the_last_one_stays() -> None:
    size = len(case_1().actions)
    held, (a, b, c) = LastPrepared(9, 2 * size), copies(3)
    of_a, of_b, of_c = used(held, a), used(held, b), used(held, c)
    assert (used(held, c), used(held, b)) == (of_c, of_b)
    assert used(held, a) is not of_a
    small = LastPrepared(9, size - 1)
    assert used(small, a) is used(small, a)


def test_a_second_call_packs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    task = case_1()
    first = serendipity.plan(task, discount=0.9)

    def init(*_: object) -> None:
        raise AssertionError("packed again")

    monkeypatch.setattr(PackedTask, "__init__", init)
    again = serendipity.plan(task, discount=0.9)
    of_session = Session(task, discount=0.9).plan()
    assert again.plan == first.plan == of_session.plan
    assert used(HELD, task).task is task


def _no_packing(*_: object) -> None:
    raise AssertionError("packed in a planning call")


@pytest.fixture
def folder(tmp_path):
    serendipity.generate_usar(tmp_path / "building", rooms=60, medkits=4, seed=1)
    return tmp_path / "building"


def test_a_large_task_is_packed_when_it_is_loaded(folder, monkeypatch):
    task = serendipity.load(folder)
    monkeypatch.setattr(PackedTask, "__init__", _no_packing)
    assert serendipity.plan(task, discount=0.6).status == "optimal"


def test_what_is_only_read_is_packed_by_the_first_call_and_both_plan_alike(folder, monkeypatch):
    task = pddl.read_folder(folder)
    with monkeypatch.context() as patch:
        patch.setattr(PackedTask, "__init__", _no_packing)
        with pytest.raises(AssertionError, match="packed in a planning call"):
            serendipity.plan(task, discount=0.6)
    loaded, read = (serendipity.plan(each, discount=0.6) for each in (serendipity.load(folder), task))
    assert (loaded.cost, loaded.plan) == (read.cost, read.plan)
