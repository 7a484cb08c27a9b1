"""A float that stands for a simple rational is that rational; what is written down is read back as it was."""

import json
from fractions import Fraction
from math import inf, nextafter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity.model.numbers import as_written, exact, unrounded
from serendipity.model.options import Options

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
