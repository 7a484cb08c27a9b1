"""The values of mode ``assistance`` equal those of brute force (semantics 7)."""

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from search.modes.assistance.distances import closure
from serendipity import Result, Task
from serendipity_testing.oracle.assistance import Costs, by_rounds, explore, mean_over_all_policies
from tests.search.modes.assistance.strategies import games

_MOST_POLICIES = 400


def value(result: Result) -> Costs | None:
    """The proved pair of a result; None where it says that there is none."""
    bounds = result.bounds
    if result.status == "infeasible":
        assert result.policy is None
        return None
    assert result.status == "optimal"
    assert bounds.lower == bounds.upper
    first, second = bounds.lower
    assert list(result.agent_costs.values()) == [float(first), float(second)]
    assert result.cost == result.objective == result.lower_bound == float(first + second)
    return first, second


def solve(task: Task, ties: str, *, no_block: bool = False) -> Costs | None:
    return value(serendipity.plan(task, mode="assistance", ties=ties, no_block=no_block))


@pytest.fixture(params=[closure.SMALL, 0], ids=["state by state", "in arrays"])
def tables(request: pytest.FixtureRequest) -> Iterator[None]:
    """From how many states on distances are found in arrays."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(closure, "SMALL", request.param)
        yield


@pytest.mark.long
@pytest.mark.usefixtures("tables")
@pytest.mark.parametrize("ties", ["optimistic", "fixed", "robust"])
@given(task=games(), no_block=st.booleans())
def test_value_is_that_of_brute_force(ties: str, task: Task, no_block: bool) -> None:
    tree = explore(task, fixed=ties == "fixed", no_block=no_block)
    assert solve(task, ties, no_block=no_block) == by_rounds(tree, max if ties == "robust" else min)


@pytest.mark.usefixtures("tables")
@given(task=games(), no_block=st.booleans())
def test_expected_value_is_the_least_over_all_policies(task: Task, no_block: bool) -> None:
    tree = explore(task, fixed=False, no_block=no_block)
    least = mean_over_all_policies(tree, _MOST_POLICIES)
    answer = solve(task, "expected", no_block=no_block)
    if least != "too many":
        assert answer == least
