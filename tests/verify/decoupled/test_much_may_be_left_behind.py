"""However much robots leave behind, it is told apart in steps: somebody looks at the clock in between."""

import numpy as np
import pytest

from serendipity.model import LimitReachedError
from serendipity_testing.countdown import Countdown
from verify.exhaustive.decoupled import leavings, rows
from verify.exhaustive.decoupled.leavings import differences, together
from verify.limits import limited
from verify.packed.cheapest_path import TooManyPackedStatesError

MANY = 10**9


def looks_of(deadline: Countdown) -> int:
    """How often it was looked at."""
    return MANY - deadline.left_over[0]


def test_too_many_together_are_given_up_as_soon_as_they_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(leavings, "_AT_ONCE", 40)
    monkeypatch.setattr(rows, "_AT_ONCE", 40)
    low = np.arange(1, 101, dtype=np.uint64).reshape(-1, 1)
    free = np.zeros(100, np.int64)
    deadline = Countdown(MANY)
    with limited(left_behind=100), pytest.raises(TooManyPackedStatesError):
        together([(low, free), (low << np.uint64(10), free)], 0, deadline)
    assert looks_of(deadline) < 100  # there are 10,000 pairs of them, which would be 100 looks and more


def test_what_one_leaves_behind_ends_at_the_deadline() -> None:
    bits = [np.array([1 << bit], dtype=np.uint64) for bit in range(12)]
    every, none = sum(bits), np.zeros(1, np.uint64)
    found, cost = differences(every.reshape(1, 1), np.array([7]), none, every, bits, Countdown(MANY))
    assert (len(found), {*map(int, cost)}) == (2**12, {7})
    with pytest.raises(LimitReachedError):
        differences(every.reshape(1, 1), np.array([7]), none, every, bits, Countdown(10))
