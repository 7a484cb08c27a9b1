"""Exact numbers: costs, discounts and weights are rationals, so ties are exact."""

from decimal import Decimal
from fractions import Fraction

from serendipity.model.errors import UsageError

Number = int | float | str | Decimal | Fraction


def exact(value: Number, what: str = "number") -> Fraction:
    """The rational that a number is written as: ``exact(0.1) == Fraction(1, 10)``.

    Args:
        value: an integer, a float (read as its shortest decimal), a decimal or
            a text such as ``"0.6"`` or ``"1/3"``.
        what: how an error calls the value.

    Raises:
        UsageError: the value is not a finite number.
    """
    if isinstance(value, Fraction):
        return value
    if isinstance(value, bool):
        raise UsageError(f"{what}: expected a number, got {value!r}")
    try:
        return Fraction(str(value).strip())
    except (ValueError, ZeroDivisionError):
        raise UsageError(f"{what}: expected a finite number, got {value!r}") from None
