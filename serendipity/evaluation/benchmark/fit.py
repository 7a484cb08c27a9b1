"""Powers that describe how a time grows: least squares on logarithms."""

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """``y = factor * x ** exponent``.

    Attributes:
        error: standard error of the exponent.
        explained: share of the variance of ``log y`` that it explains (R squared).
    """

    exponent: float
    factor: float
    error: float
    explained: float

    def at(self, x: float) -> float:
        """The value at ``x``."""
        return float(self.factor * x**self.exponent)


def power_law(points: Sequence[tuple[float, float]]) -> PowerLaw | None:
    """The power law of least squared distance between logarithms.

    Args:
        points: positive ``(x, y)``.

    Returns:
        None for fewer than three points, or a single x.
    """
    xs = [math.log(x) for x, _ in points]
    ys = [math.log(y) for _, y in points]
    if len(points) < 3 or len(set(xs)) < 2:
        return None
    mean_x, mean_y = math.fsum(xs) / len(xs), math.fsum(ys) / len(ys)
    spread = math.fsum((x - mean_x) ** 2 for x in xs)
    slope = math.fsum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys, strict=True)) / spread
    start = mean_y - slope * mean_x
    left = math.fsum((y - start - slope * x) ** 2 for x, y in zip(xs, ys, strict=True))
    total = math.fsum((y - mean_y) ** 2 for y in ys)
    return PowerLaw(
        exponent=slope,
        factor=math.exp(start),
        error=math.sqrt(left / (len(xs) - 2) / spread),
        explained=1 - left / total if total else 1.0,
    )
