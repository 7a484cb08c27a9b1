"""Techniques of the kernel's A* and bounds of spaces: answers are the same without any of them."""

import pytest

import serendipity
from benchmarks.techniques import NAMES, without
from search.kernel.library import library
from serendipity_testing.generator.families import FAMILIES, family_task

CALLS = (
    {"mode": "individual"},
    {"mode": "composite", "horizon": "inf", "discount": "0.9"},
    {"mode": "serendipity", "window_weight": 0, "discount": "0.9"},
)


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("call", CALLS, ids=lambda call: call["mode"])
def test_costs_are_the_same_without(call: dict[str, object], name: str) -> None:
    for family in FAMILIES:
        task = family_task(family, 3, 2)
        expected = serendipity.plan(task, **call)
        with without(name):
            found = serendipity.plan(task.at(task.init), **call)
        assert (found.status, found.cost) == (expected.status, expected.cost)
