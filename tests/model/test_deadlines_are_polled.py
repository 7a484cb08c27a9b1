"""A deadline ends long loops, and counts what a process of ours has in memory."""

import os
import threading

import pytest

from serendipity.model import Deadline, LimitReachedError
from serendipity.model.resources.memory import resident
from serendipity.testing.cases import case_4
from serendipity.testing.countdown import Countdown


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
