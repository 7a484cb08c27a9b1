"""Figures are exactly what was found, in memory and in JSON, whatever the costs are.

A float that stands for a simple rational is that rational; what is written down is read back as it was.
"""

import json
import pickle
from dataclasses import replace
from fractions import Fraction
from math import inf, nextafter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity import Result, plan, verify
from serendipity.model import InputError
from serendipity.model.numbers import Figure, as_written, exact, excess, unrounded
from serendipity.model.options import Options
from serendipity_testing import task

_FLOATS = st.floats(min_value=0, max_value=1e300, allow_nan=False) | st.builds(
    lambda p, q, steps: _moved(p / q, steps),
    st.integers(1, 10**7),
    st.integers(1, 10**7),
    st.integers(-12, 12),
)


def _moved(value: float, steps: int) -> float:
    for _ in range(abs(steps)):
        value = nextafter(value, inf if steps > 0 else 0)
    return value


@pytest.mark.parametrize(
    ("value", "meant"),
    [
        (0.1, "0.1"),
        (0.1 + 0.2, "0.3"),
        (1 - 0.95, "0.05"),
        (2 / 3, "2/3"),
        (128 / 7, "128/7"),
        (9983 / 9973, "9983/9973"),
        (1.0000001 + 0.3, "1.3000001"),
        (0.666666666667, "0.666666666667"),
        (0.666666666666667, "0.666666666666667"),
        (2.0**53, "9007199254740992"),
        (1e23, "1e23"),
        ("0.6666666666666666", "0.6666666666666666"),
        ("2/3", "2/3"),
    ],
)
def test_what_is_meant(value: float | str, meant: str) -> None:
    assert exact(value) == as_written(value) == Fraction(meant)


@given(st.integers(1, 10**6), st.integers(1, 10**6))
def test_quotients_are_themselves(numerator: int, denominator: int) -> None:
    meant, decimal = exact(numerator / denominator), Fraction(repr(numerator / denominator))
    assert meant in (Fraction(numerator, denominator), decimal)
    assert meant != decimal or meant == Fraction(f"{numerator / denominator:.15g}")


@given(st.integers(0, 10**15 - 1), st.integers(-30, 30))
def test_decimals_of_fifteen_digits_are_themselves(digits: int, exponent: int) -> None:
    text = f"{digits}e{exponent}"
    assert exact(float(text)) == Fraction(text)


@given(_FLOATS)
def test_near_idempotent_and_of_either_sign(value: float) -> None:
    meant = exact(value)
    assert abs(meant - Fraction(value)) <= Fraction(value) / 10**15 + Fraction(5e-324)
    assert exact(float(meant)) == meant
    assert exact(-value) == -meant


@given(_FLOATS, st.integers(1, 12))
def test_more_never_means_less(value: float, steps: int) -> None:
    assert exact(value) <= exact(_moved(value, steps))


@given(st.fractions(0, 1) | st.decimals(0, 1, places=17).map(Fraction))
def test_options_are_read_back(share: Fraction) -> None:
    assert as_written(unrounded(share)) == share
    options = Options(discount=share, window_weight=share * 10**9)
    assert Options.from_dict(json.loads(json.dumps(options.to_dict()))) == options


_ODD = Fraction(1012, 997) + Fraction(9984, 9973) + Fraction(1, 10**15 + 37)
_TASK = task(
    goal="g",
    actions={
        "do h": f"-> g @ {_ODD + 7}",
        "do2 h": f"-> g @ {_ODD + 7}",
        "quick h": "q -> g @ 53/130",
        "open r": f"-> q @ {_ODD}",
        "both h r": "q -> g @ 4/7",
    },
)
_CALLS = (
    {"mode": "individual"},
    {"discount": Fraction(2, 3), "horizon": 2},
    {"discount": Fraction(2, 3), "horizon": 2, "ties": "expected"},
    {"mode": "communication", "horizon": 2, "communication_weight": Fraction(1, 7)},
    {"mode": "composite", "horizon": "inf", "discount": Fraction(1, 10**15 + 37)},
    {"mode": "composite", "horizon": 2},
    {"human_model": "observant", "horizon": 2},
    {"goals": ({"goal": ("g",), "prior": Fraction(2, 7)}, {"goal": ("q", "g"), "prior": Fraction(5, 7)})},
)


def _reread(result: Result) -> Result:
    return Result.from_dict(json.loads(json.dumps(result.to_dict())))


@pytest.mark.parametrize("options", _CALLS, ids=str)
def test_right_answers_are_proved_and_read_back(options: dict[str, object]) -> None:
    result = plan(_TASK, **options)  # type: ignore[arg-type]
    again = _reread(result)
    assert again == result
    assert again.to_dict() == result.to_dict()
    assert as_written(again.cost or 0.0) == as_written(result.cost or 0.0)
    for said in (result, again):
        assert verify(_TASK, said).verdict == "proved"


def test_what_is_exact_is_what_was_planned() -> None:
    result = plan(_TASK, mode="individual")
    assert isinstance(result.cost, Figure)
    assert as_written(_reread(result).cost or 0.0) == _ODD + 7
    assert as_written(pickle.loads(pickle.dumps(result)).cost) == _ODD + 7


@pytest.mark.parametrize("name", ["cost", "saving", "human_cost", "lower_bound", "objective"])
def test_figures_that_only_their_exact_texts_make_false_are_refuted(name: str) -> None:
    result = plan(_TASK, discount=Fraction(2, 3), horizon=2)
    nudged = Figure(as_written(getattr(result, name)) + Fraction(1, 10**30))
    assert nudged == getattr(result, name)
    assert verify(_TASK, replace(result, **{name: nudged})).verdict == "refuted"


@pytest.mark.parametrize(
    "exact",
    [[], "1", {"cost": 1}, {"cost": "1"}, {"cost": "x"}, {"nothing": "1"}, {"plan": {"9": {"cost": "1"}}}],
    ids=str,
)
def test_exact_texts_of_other_figures_are_an_error(exact: object) -> None:
    data = plan(_TASK, mode="individual").to_dict()
    with pytest.raises(InputError, match="exact"):
        Result.from_dict({**data, "exact": exact})


def test_how_much_more_a_figure_is() -> None:
    """A float is as much as what rounds to it; an exact one differs by however little."""
    third, trifle = Fraction(1, 3), Fraction(1, 10**30)
    assert excess(float(third), third + trifle) == 0
    assert excess(Figure(third + trifle), third) == trifle
    assert excess(0.25, third) == Fraction(-1, 12)
