"""What robots can leave behind may be too much to be looked at: then somebody says so in time."""

import numpy as np
import pytest

from search.short_windows.independent.outcomes import outcomes
from search.short_windows.independent.rows import cheapest
from search.short_windows.independent.timeline import Layer, TooManyStatesError
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.countdown import Countdown

FIELDS = [1 << bit for bit in range(40)]


def all_set() -> Layer:
    """One state, in which a robot has set everything."""
    return Layer(np.array([[sum(FIELDS)]], dtype=np.uint64), np.array([7]), np.array([True]))


def test_each_field_that_others_set_too_may_be_left_to_them() -> None:
    found = outcomes(all_set(), 0, FIELDS[:5], sum(FIELDS[:3]), {}, Deadline())
    assert sorted(found.rows[0]) == [0b11000 | low for low in range(8)]
    assert set(found.amounts) == {7}


def test_too_many_are_given_up() -> None:
    with pytest.raises(TooManyStatesError):
        outcomes(all_set(), 0, FIELDS, sum(FIELDS), {}, Deadline())


def test_the_clock_is_looked_at() -> None:
    with pytest.raises(LimitReachedError, match="time limit"):
        outcomes(all_set(), 0, FIELDS, sum(FIELDS), {}, Deadline(time_limit=0))


def test_the_clock_is_looked_at_word_by_word() -> None:
    for looks in range(3):
        with pytest.raises(LimitReachedError):
            cheapest(np.zeros((3, 5), dtype=np.uint64), np.zeros(5, dtype=np.int64), Countdown(looks))
