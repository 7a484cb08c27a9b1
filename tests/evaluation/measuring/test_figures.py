"""Exponents are exact on powers, and None where there is nothing to fit; memory grows with what is held."""

import pytest

from serendipity.evaluation.measuring.figures import peak_memory, percentile, power_law


def test_a_power_is_found_exactly() -> None:
    xs = (1, 10, 100, 250)
    fit = power_law(xs, [3 * x**1.5 for x in xs])
    assert fit is not None
    assert fit.exponent == pytest.approx(1.5)
    assert fit.factor == pytest.approx(3)
    assert fit.error == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("xs", [[], [1, 2], [3, 3, 3]])
def test_too_little_to_fit(xs: list[float]) -> None:
    assert power_law(xs, range(1, len(xs) + 1)) is None


def test_peak_memory_grows_with_what_is_held() -> None:
    before = peak_memory()
    held = b"x" * int((before + 32) * 2**20)  # more than there ever was
    assert peak_memory() > before + 16
    del held


def test_percentiles_are_values_that_are_there() -> None:
    assert [percentile([3, 1, 2], share) for share in (0, 0.5, 0.95, 1)] == [1, 2, 3, 3]
    assert percentile(range(1, 101), 0.95) == 96
