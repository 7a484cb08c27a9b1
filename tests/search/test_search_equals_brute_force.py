"""The search answers what brute force answers, on random small tasks, in every mode and option."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Final

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from search.call.context import SearchContext
from serendipity import Task
from serendipity_testing.strategies import Call, calls, family_tasks, oddly_priced_tasks, tasks
from tests.search.exact_answers import assert_answered


@pytest.mark.parametrize("of", [tasks, family_tasks, oddly_priced_tasks])
@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite", "individual"])
def test_search_equals_brute_force(mode: str, of: Callable[[], SearchStrategy[Task]]) -> None:
    @given(calls(modes=(mode,), of=of()))
    def law(call: Call) -> None:
        assert_answered(call)

    law()


_MODES: Final = ("serendipity", "communication", "composite", "individual")

_TEXTS = "0 1 1.000000000001 0.000001 549756 549755813888 1e15 1/999999999989 4/7"
_EXTREME: Final = tuple(map(Fraction, _TEXTS.split()))
"""Costs that no word holds in a common unit, some of them equal but for their last digit."""


@st.composite
def extreme(draw: st.DrawFn) -> Call:
    call = draw(calls(modes=_MODES))
    prices = {cost: draw(st.sampled_from(_EXTREME)) for cost in sorted({a.cost for a in call.task.actions})}
    actions = tuple(replace(action, cost=prices[action.cost]) for action in call.task.actions)
    options = call.options.but(
        discount=draw(st.sampled_from((0, Fraction(2, 3), "0.666666666667", 1))),
        window_weight=draw(st.sampled_from((0, 1000, 10**9, Fraction(1, 10**9 + 7)))),
        max_cost=None if call.options.max_cost != "human" else "human",
    )
    return replace(call, task=replace(call.task, actions=actions), options=options)


@pytest.mark.long
@pytest.mark.parametrize(("kernel", "as_if_large"), [("on", False), ("on", True), ("off", False)])
def test_with_costs_however_far_apart(
    kernel: str, as_if_large: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the kernel and without it, and in tables of words, which are for large tasks otherwise."""
    monkeypatch.setenv("SERENDIPITY_KERNEL", kernel)
    if as_if_large:
        monkeypatch.setattr(SearchContext, "distances_say_little", True)

    @given(extreme())
    def law(call: Call) -> None:
        assert_answered(replace(call, options=call.options.but(strategies="-few-nodes")))

    law()
