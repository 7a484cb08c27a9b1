"""Patterns are worked out one at a time, so that who makes tables of them can look at the clock between."""

import pytest

from search.abstractions import patterns as module
from search.abstractions.patterns import Field, patterns
from search.packed.packed_task import PackedTask
from serendipity.model import Deadline
from serendipity.testing.builders import task

COUNT = 6


def test_none_is_grown_before_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """With 291 fields all of them together took 0.3 s, after which the time limit was looked at."""
    chain = {f"do{i} h": f"f{i} -> f{i + 1}" for i in range(COUNT)} | {"help r": "-> f1"}
    packed = PackedTask(
        task(goal=" ".join(f"f{i + 1}" for i in range(COUNT)), init="f0", actions=chain),
        frozenset(),
        Deadline(),
    )
    fields = [Field(f, (f & -f).bit_length() - 1, len(packed.values(f))) for f in packed.fields]
    grown = []
    original = module._grown
    monkeypatch.setattr(module, "_grown", lambda *given: grown.append(given[0]) or original(*given))
    found = patterns(fields, packed.own, packed.goal, 1_000)
    assert grown == []
    first = next(found)
    assert len(grown) == 1
    everything = [first, *found]
    assert len(grown) == COUNT
    assert len(set(everything)) == len(everything)
