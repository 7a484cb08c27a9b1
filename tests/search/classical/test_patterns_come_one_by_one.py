"""Patterns are worked out one at a time, so that who makes tables of them can look at the clock between."""

import pytest

from search.classical import patterns as module
from search.classical.patterns import StateField, patterns
from search.packed.packed_task import PackedTask
from serendipity.model import Deadline, LimitReachedError
from serendipity.testing.builders import task
from serendipity.testing.countdown import Countdown

COUNT = 6


def chained() -> tuple[PackedTask, list[StateField]]:
    """One thing after another, each asked for by the next, all of them by the goal."""
    chain = {f"do{i} h": f"f{i} -> f{i + 1}" for i in range(COUNT)} | {"help r": "-> f1"}
    packed = PackedTask(
        task(goal=" ".join(f"f{i + 1}" for i in range(COUNT)), init="f0", actions=chain),
        frozenset(),
        Deadline(),
    )
    return packed, [(field, len(packed.values(field))) for field in packed.fields]


def test_none_is_grown_before_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """With 291 fields all of them together took 0.3 s, after which the time limit was looked at."""
    packed, fields = chained()
    grown = []
    original = module._grown
    monkeypatch.setattr(module, "_grown", lambda *given: grown.append(given[0]) or original(*given))
    found = patterns(fields, packed.own, packed.goal, 1_000, Deadline())
    assert grown == []
    first = next(found)
    assert len(grown) == 1
    everything = [tuple(pattern) for pattern in (first, *found)]
    assert len(grown) == COUNT
    assert len(set(everything)) == len(everything)


def test_the_clock_is_looked_at_before_the_first_one() -> None:
    """In blocksworld with 16 blocks what stands near what took 0.16 s."""
    packed, fields = chained()
    for looks in range(2):
        with pytest.raises(LimitReachedError):
            next(patterns(fields, packed.own, packed.goal, 1_000, Countdown(looks)))
