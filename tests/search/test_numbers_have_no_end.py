"""What plans cost is added up exactly, however much it is: with the kernel, whose words end, or without."""

from fractions import Fraction
from itertools import pairwise

import pytest

import serendipity
from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.packed.cost_vector import ACTIONS_BITS
from serendipity import Deadline, Options, Task, UsageError
from serendipity.model.numbers import as_written
from serendipity_testing import task


@pytest.fixture(autouse=True, params=["on", "off"])
def kernel(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SERENDIPITY_KERNEL", request.param)


@pytest.mark.parametrize(
    ("cost", "other"),
    [
        ("549755", "0.000001"),
        ("549756", "0.000001"),
        ("1", "1.000000000001"),
        ("549755813888", "1"),
        ("1000000000000000", "1/999999999999989"),
    ],
)
@pytest.mark.parametrize("human_model", ["omniscient", "observant"])
def test_dear_plans_are_plans(cost: str, other: str, human_model: str) -> None:
    given = task(goal="g", actions={"a h": f"-> g @ {cost}", "b r": f"-> !g @ {other}"})
    for mode in ("individual", "serendipity"):
        model = {"human_model": human_model} if mode == "serendipity" else {}
        result = serendipity.plan(given, mode=mode, **model)  # type: ignore[arg-type]
        assert (result.status, as_written(result.cost or 0.0)) == ("optimal", Fraction(cost))


def test_levels_that_need_both_of_the_level_below() -> None:
    """Additive costs of supporters double from level to level."""
    actions = {"x0 h": "-> a0", "y0 h": "-> b0", "rr r": "-> !a70"}
    for before, level in pairwise(range(71)):
        actions[f"x{level} h"] = f"a{before} b{before} -> a{level}"
        actions[f"y{level} h"] = f"a{before} b{before} -> b{level}"
    given = task(goal="a70", actions=actions)
    result = serendipity.plan(given, mode="composite", horizon="inf", time_limit=20)
    assert (result.status, result.cost) == ("optimal", 141)


def _counter(bits: int, cost: str) -> Task:
    """Who counts to 2^bits - 1 pays as often."""
    actions = {
        f"up{bit} h": " ".join([f"!b{bit}", *(f"b{k}" for k in range(bit)), "->", f"b{bit}"])
        + "".join(f" !b{k}" for k in range(bit))
        + f" @ {cost}"
        for bit in range(bits)
    }
    goal = " ".join(f"b{bit}" for bit in range(bits))
    return task(goal=goal, actions={**actions, "look h": "b0 -> c", "rr r": "b0 -> !b0"})


@pytest.mark.parametrize("mode", ["individual", "composite"])
def test_long_plans_cost_more_than_all_actions_together(mode: str) -> None:
    """Each action fits the kernel's words, and so do all of them; the plan does not."""
    horizon = "inf" if mode == "composite" else None
    result = serendipity.plan(_counter(9, "2000001"), mode=mode, horizon=horizon)
    assert (result.status, result.cost) == ("optimal", 511 * 2_000_001)


def test_denominators_without_end_are_refused_in_one_line() -> None:
    actions = {f"a{k} h": f"-> g @ {Fraction(1, 10**99 + k)}" for k in range(60)}
    given = task(goal="g", actions={**actions, "b r": "-> !g"})
    with pytest.raises(UsageError, match="common denominator") as caught:
        serendipity.plan(given)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("mode", ["serendipity", "communication"])
def test_the_least_amount_of_a_key(mode: str) -> None:
    given = task(goal="g", actions={"a h": "-> g @ 1/3", "b r": "-> !g @ 5/2"})
    options = Options(mode=mode, discount="0.7", window_weight="0.01")
    weights = SearchContext(PreparedTask(given), options, Deadline()).weights
    last = (1 << ACTIONS_BITS) - 1  # the most actions: one more is a cost more, and none
    for amount in (0, 1, 17, last, last + 1, (123 << ACTIONS_BITS) + 45, (1 << 60) + last):
        key = weights.key_of(amount)
        assert [weights.amount_from(key + more, 1 << 61) for more in (0, 1)] == [amount, amount + 1]
        assert weights.amount_from(key + 1, amount) == amount
    assert weights.amount_from(-5, 7) == 0
