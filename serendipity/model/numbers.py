"""Exact numbers: costs, discounts and weights are rationals, so ties are exact."""

from collections.abc import Iterable
from decimal import Decimal
from fractions import Fraction
from typing import Final

from serendipity.model.errors import UsageError

Number = int | float | str | Decimal | Fraction

MOST_DIGITS: Final = 100
"""Digits of a number, and its decimal exponent: such numbers and their sums have floats."""


MOST_IN_RESULTS: Final = 4_000
"""Digits of a number that was computed: sums and means of those that are written down."""


def exact(value: Number, what: str = "number", most: int = MOST_DIGITS) -> Fraction:
    """The rational that a number is written as: ``exact(0.1) == Fraction(1, 10)``.

    Args:
        value: an integer, a float (read as its shortest decimal), a decimal or
            a text such as ``"0.6"`` or ``"1/3"``.
        what: how an error calls the value.
        most: digits that it may have.

    Raises:
        UsageError: the value is not a finite number, has too many digits, or no float.
    """
    if isinstance(value, Fraction):
        return value
    if isinstance(value, bool):
        raise UsageError(f"{what}: expected a number, got {value!r}")
    try:
        found = fraction(str(value).strip(), most)
        float(found)
        return found
    except (ValueError, ArithmeticError):
        most_of = f" of at most {most} digits" if _is_finite(str(value).strip()) else ""
        raise UsageError(f"{what}: expected a finite number{most_of}, got {value!r:.50}") from None


def _is_finite(text: str) -> bool:
    try:
        return Decimal(text).is_finite()
    except ArithmeticError:
        return False


def fraction(text: str, most: int = MOST_DIGITS) -> Fraction:
    """The rational that a text writes down.

    Raises:
        ValueError: it writes down none, or one of more than ``most`` digits.
        ZeroDivisionError: its denominator is 0.
    """
    exponent = text.lower().partition("e")[2]
    if len(text) > most or (exponent and abs(int(exponent)) > MOST_DIGITS):
        raise ValueError
    return Fraction(text)


def as_written(value: float | str) -> Fraction:
    """The rational that a figure in a result stands for: the shortest decimal that is this float.

    Figures are rounded when they are written down, so it is the exact one where that has few digits.
    """
    return Fraction(str(value))


def unrounded(value: Fraction) -> float | str:
    """A rational as JSON has it: as the float that stands for it, or as a text where none does."""
    return float(value) if as_written(float(value)) == value else str(value)


def rounded(value: Fraction | None) -> float | None:
    """A figure as results have it; None where there is none."""
    return None if value is None else float(value)


def total(values: Iterable[Fraction]) -> Fraction:
    """The sum of rationals; with few different denominators, as costs have, it adds integers."""
    numerators: dict[int, int] = {}
    for value in values:
        numerator, denominator = value.as_integer_ratio()
        numerators[denominator] = numerators.get(denominator, 0) + numerator
    return sum((Fraction(numerator, of) for of, numerator in numerators.items()), Fraction(0))


def plain(value: Fraction | float | None) -> str:
    """A cost as people write it: ``13``, ``12.6``; ``-`` where there is none."""
    return "-" if value is None else f"{float(value):.10g}"
