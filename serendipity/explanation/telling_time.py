"""Epochs in words, with the time where there is a clock."""

from fractions import Fraction

from serendipity.model.numbers import plain


def begin(length: Fraction | None, epoch: int) -> str:
    """An epoch, with the time at its beginning where there is a clock; ``length``: of an epoch."""
    return f"epoch {epoch}" if length is None else f"epoch {epoch}, at {end(length, epoch - 1)}"


def end(length: Fraction | None, epoch: int) -> str:
    """The time at the end of an epoch."""
    return plain((length or 1) * epoch)
