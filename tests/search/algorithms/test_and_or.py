"""Least values in AND-OR graphs equal those by applying every rule until nothing changes."""

from collections.abc import Callable, Iterable, Mapping

import pytest
from hypothesis import given
from hypothesis import strategies as st

from search.engine.and_or import AndOrGraph, Rule
from serendipity.model.resources.deadline import Deadline

STATES = range(6)
LIMIT = 40

some = st.frozensets(st.sampled_from(STATES), max_size=3)
rules = st.lists(st.tuples(st.builds(Rule, some, some), st.integers(0, 4)), max_size=8)


def by_every_rule(
    listed: list[tuple[Rule[int], int]], given: Iterable[int], combine: Callable[[list[int]], int]
) -> dict[int, int]:
    """What each state costs, found by trying all rules again and again."""
    found = dict.fromkeys(given, 0)
    for _ in range(len(STATES) * LIMIT):
        known = dict(found)
        for rule, weight in listed:
            if all(state in found for state in rule.tails):
                cost = combine([found[state] for state in rule.tails]) + weight
                for state in rule.heads:
                    if cost < found.get(state, LIMIT):
                        found[state] = cost
        if found == known:
            break
    return found


def greatest(values: list[int]) -> int:
    return max(values, default=0)


@pytest.mark.parametrize("combine", [greatest, sum])
@given(listed=rules, free=some)
def test_least_values(
    combine: Callable[[list[int]], int], listed: list[tuple[Rule[int], int]], free: frozenset[int]
) -> None:
    def value(k: int, values: Mapping[int, int]) -> int:
        return combine([values[state] for state in listed[k][0].tails]) + listed[k][1]

    graph = AndOrGraph([rule for rule, _ in listed], Deadline())
    values, chosen = graph.settle(free, value, LIMIT)
    assert values == by_every_rule(listed, free, combine)
    assert set(chosen) == set(values) - free
    for state, k in chosen.items():
        assert state in listed[k][0].heads
        assert value(k, values) == values[state]
