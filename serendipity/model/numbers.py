"""Exact numbers: costs, discounts and weights are rationals, so ties are exact."""

from collections.abc import Iterable
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from math import ceil, floor, isfinite
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
        value: an integer, a float (read as :func:`meant` by it), a decimal or a text such
            as ``"0.6"`` or ``"1/3"``, which are exactly what they say.
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
        if isinstance(value, float) and isfinite(value):
            return meant(value)
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


_SURE_DIGITS: Final = 15
"""Decimals of so many digits have floats of their own."""

_NEAR: Final = Fraction(1, 10**15)
"""The part of a float by which it may differ from what it stands for: a few units in the last place."""

_SIMPLE: Final = 10**12
"""Numerator times denominator of simple rationals: hardly any float is so near to one by chance."""


def meant(value: float) -> Fraction:
    """The rational that a finite float stands for: ``meant(2 / 3) == Fraction(2, 3)``.

    The first of these that there is:

    1. the decimal that it is shown as, if that has at most 15 digits or is a whole number;
    2. the simplest rational within one part in 10^15 of it, if that one's numerator times its
       denominator is at most 10^12: ``meant(0.1 + 0.2) == Fraction(3, 10)``;
    3. the decimal of 15 digits that is nearest to it, if it is within one part in 10^15;
    4. the decimal that it is shown as: the shortest that is this float.

    Nothing of the first kind may be between the float and what it stands for, so greater floats never
    stand for less; and the float of what it stands for stands for the same.
    """
    if isinstance(value, Figure):
        return value.exact
    text = repr(float(value))
    shown = Fraction(text)
    if len(text) <= _SURE_DIGITS + 1 or shown.denominator == 1 or _sure(text, ROUND_HALF_EVEN) == shown:
        return shown
    if value < 0:
        return -meant(-value)
    low = max(shown * (1 - _NEAR), _sure(text, ROUND_FLOOR), Fraction(floor(shown)))
    high = min(shown * (1 + _NEAR), _sure(text, ROUND_CEILING), Fraction(ceil(shown)))
    found = _simplest(low, high)
    if found.numerator * found.denominator <= _SIMPLE:
        short = _sure(repr(float(found)), ROUND_HALF_EVEN)
        return short if float(short) == float(found) else found
    nearest = _sure(text, ROUND_HALF_EVEN)
    return nearest if low <= nearest <= high else shown


def _sure(text: str, rounding: str) -> Fraction:
    """The decimal of 15 digits next to a number."""
    return Fraction(Context(_SURE_DIGITS, rounding).create_decimal(text))


def _simplest(low: Fraction, high: Fraction) -> Fraction:
    """Of the rationals between two positive ones the one with the least numerator and denominator."""
    whole = -(-low.numerator // low.denominator)
    if whole <= high:
        return Fraction(whole)
    return whole - 1 + 1 / _simplest(1 / (high - whole + 1), 1 / (low - whole + 1))


class Figure(float):
    """A float in a result that stands for another rational than what it is :func:`meant` as: ``exact``."""

    __slots__ = ("exact",)

    exact: Fraction

    def __new__(cls, value: Fraction) -> "Figure":
        """The nearest float of a rational."""
        found = super().__new__(cls, float(value))
        found.exact = value
        return found

    def __reduce__(self) -> tuple[type["Figure"], tuple[Fraction]]:
        return Figure, (self.exact,)


def as_written(value: float | str) -> Fraction:
    """The rational that a figure in a result stands for: what a float is :func:`meant` as, a text says."""
    return meant(value) if isinstance(value, float) else Fraction(value)


def unrounded(value: Fraction) -> float | str:
    """A rational as options in JSON have it: a float where its shortest decimal is that, else a text."""
    return float(value) if Fraction(repr(float(value))) == value == meant(float(value)) else str(value)


def figure(value: Fraction) -> float:
    """A rational as results have it: its nearest float, which :func:`as_written` reads back as it was."""
    found = float(value)
    return found if meant(found) == value else Figure(value)


def rounded(value: Fraction | None) -> float | None:
    """A figure as results have it; None where there is none."""
    return None if value is None else figure(value)


def agrees(said: float | None, value: Fraction | None) -> bool:
    """Whether a figure of a result is a rational: that one if it is exact, else its nearest float."""
    if said is None or value is None:
        return said is None and value is None
    return said.exact == value if isinstance(said, Figure) else said == float(value)


def excess(said: float, value: Fraction) -> Fraction:
    """By how much a figure of a result is more than a rational; 0 where it agrees with it."""
    return Fraction(0) if agrees(said, value) else as_written(said) - value


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


def short(value: Fraction | float) -> str:
    """A figure for a glance: of up to four digits, or rounded to an integer."""
    return f"{float(value):.4g}" if abs(float(value)) < 1000 else f"{float(value):.0f}"


def plain_seconds(seconds: float) -> str:
    """A time as people write it: ``2.05 s``, ``3.1 ms``."""
    return f"{seconds:.2f} s" if seconds >= 1 else f"{seconds * 1000:.1f} ms"
