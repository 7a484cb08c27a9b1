"""However much robots leave behind, it is told apart in steps: somebody looks at the clock in between."""

from collections.abc import Iterator

import numpy as np
import pytest

from serendipity.model import LimitReachedError
from serendipity.testing.countdown import Countdown
from verify.exhaustive.decoupled import leavings, rows
from verify.exhaustive.decoupled.leavings import differences, together
from verify.exhaustive.decoupled.rows import Collected, RowLayer
from verify.limits import limited
from verify.packed.cheapest_path import TooManyPackedStatesError

MANY = 10**9


def drawn(seed: int, number: int = 60) -> RowLayer:
    """Rows of three words, some of them alike."""
    dice = np.random.default_rng(seed)
    words = dice.integers(0, 3, (number, 3)).astype(np.uint64)
    return RowLayer(words, dice.integers(0, 4, number), dice.integers(0, 2, number).astype(bool))


def are_by_hand(found: RowLayer, layer: RowLayer) -> bool:
    """Whether each row of a layer is there once, at its least cost, and fresh only if one at that cost is."""
    every = list(entries(layer))
    least = {row: min(paid for other, paid, _ in every if other == row) for row, _, _ in every}
    there = list(entries(found))
    return (
        {row: paid for row, paid, _ in there} == least
        and len(there) == len(least)
        and set(there) <= set(every)
    )


def entries(layer: RowLayer) -> Iterator[tuple[tuple[int, ...], int, bool]]:
    """Its rows as Python's own."""
    for row, paid, fresh in zip(*layer, strict=True):
        yield tuple(map(int, row)), int(paid), bool(fresh)


def looks_of(deadline: Countdown) -> int:
    """How often it was looked at."""
    return MANY - deadline.left_over[0]


@pytest.mark.parametrize("seed", range(20))
def test_each_row_is_there_once(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows, "_AT_ONCE", 10)
    layer, deadline = drawn(seed), Countdown(MANY)
    at_once, collected = Collected(3, 60, deadline), Collected(3, 60, Countdown(MANY))
    at_once.add(*layer)
    for first in range(0, 60, 7):
        collected.add(*(part[first : first + 7] for part in layer))
    assert are_by_hand(at_once.layer(), layer) and are_by_hand(collected.layer(), layer)
    assert looks_of(deadline) >= 6


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
