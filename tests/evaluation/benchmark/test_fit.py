"""Exponents: exact on powers, None where there is nothing to fit."""

import pytest

from serendipity.evaluation.benchmark.fit import power_law


def test_a_power_is_found_exactly() -> None:
    fit = power_law([(x, 3 * x**1.5) for x in (1, 10, 100, 250)])
    assert fit is not None
    assert fit.exponent == pytest.approx(1.5)
    assert fit.factor == pytest.approx(3)
    assert fit.error == pytest.approx(0, abs=1e-6)
    assert fit.explained == pytest.approx(1)
    assert fit.at(4) == pytest.approx(24)


def test_scatter_shows_in_the_error() -> None:
    """By hand: logarithms (0, 0), (1, 1), (1, -1) in base ten have slope 0, error sqrt(2 / (2 / 3))."""
    fit = power_law([(1, 1), (10, 10), (10, 0.1)])
    assert fit is not None
    assert fit.exponent == pytest.approx(0)
    assert fit.error == pytest.approx(3**0.5)
    assert fit.explained == pytest.approx(0)


@pytest.mark.parametrize("points", [[], [(1, 1), (2, 2)], [(3, 1), (3, 2), (3, 4)]])
def test_too_little_to_fit(points: list[tuple[float, float]]) -> None:
    assert power_law(points) is None
