"""A deadline ends long loops, counts what a process of ours has in memory, and is kept beside large tasks.

There a collection takes longer than a short deadline: there is none while it plans.
"""

import gc
import os
import threading

import pytest

import serendipity
from serendipity.model import Deadline, LimitReachedError
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.memory import resident
from serendipity_testing.cases import case_4
from serendipity_testing.countdown import Countdown


@pytest.mark.parametrize("count", [0, 1, 64, 65, 1000])
def test_every_item_comes_and_every_64th_is_a_look(count: int) -> None:
    deadline = Countdown(10**6)
    assert list(deadline.each(range(count))) == list(range(count))
    assert 10**6 - deadline.left_over[0] == -(-count // 64)


def test_a_loop_without_end_ends() -> None:
    endless = iter(int, 1)
    with pytest.raises(LimitReachedError, match="the time limit came first"):
        sum(Deadline(0.05).each(endless))


@pytest.mark.skipif(resident(os.getpid()) is None, reason="another process's memory is known on Linux")
def test_memory_of_a_process_that_works_for_us_counts() -> None:
    used = (resident() or 0) / 2**20
    Deadline(memory_limit=3 * used).check_child(os.getpid())
    with pytest.raises(LimitReachedError, match="memory is used up"):
        Deadline(memory_limit=1.5 * used).check_child(os.getpid())


def test_variables_are_found_anew_under_a_deadline_where_they_no_longer_fit() -> None:
    task = case_4()
    assert task.at(task.init, Deadline(0)).variables is task.variables
    with pytest.raises(LimitReachedError):
        task.at(frozenset(), Deadline(0))


def test_a_part_is_cancelled_with_the_whole() -> None:
    """A cancel flag of the part's own replaced that of the whole."""
    whole, own = threading.Event(), threading.Event()
    part = Deadline(cancelled=whole).within(cancelled=own)
    part.check()
    whole.set()
    with pytest.raises(LimitReachedError, match="cancelled"):
        part.check()


@pytest.fixture
def seen():
    return []


@pytest.fixture
def asked(seen):
    def visible(*_):
        seen.append(gc.isenabled())
        return True

    return {"task": serendipity.example("room2"), "human_model": "local", "visible": visible, "discount": 0.6}


def test_the_collector_is_off_while_it_plans_and_on_between_answers_and_behind(asked, seen):
    between = [gc.isenabled() for _ in serendipity.plan_anytime(**asked)]
    serendipity.plan(**asked)
    assert seen and not any(seen)
    assert all(between) and gc.isenabled()


def test_what_stays_is_not_looked_at_at_the_end():
    started = []
    gc.collect()
    gc.callbacks.append(lambda *event: started.append(event))
    try:
        with no_collection():
            kept = [[] for _ in range(100_000)]
        kept.append([])
    finally:
        gc.callbacks.pop()
    assert not started


def test_what_the_caller_has_frozen_stays_so():
    gc.collect()
    gc.freeze()
    try:
        frozen = gc.get_freeze_count()
        with no_collection():
            kept = [[] for _ in range(100_000)]
        assert gc.get_freeze_count() == frozen
        assert kept
    finally:
        gc.unfreeze()
