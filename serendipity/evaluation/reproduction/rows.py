"""One row per task, mode and discount."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from serendipity.model import Window
from serendipity.model.numbers import as_written, rounded

KINDS: Final = {
    "test": str,
    "mode": str,
    "discount": float,
    "cost": float,
    "human_cost": float,
    "window_start": int,
    "window_end": int,
    "seconds": float,
    "status": str,
    "opportunity": bool,
    "best_tie": float,
    "worst_tie": float,
    "reason": str,
}
"""The columns of a table of rows, and their types; the first eight are those of the paper's tables."""

COLUMNS: Final = tuple(KINDS)
SHORT: Final = COLUMNS.index("best_tie")
"""Number of columns that are printed."""

_COSTS: Final = ("cost", "human_cost", "best_tie", "worst_tie")


@dataclass(frozen=True, slots=True)
class Row:
    """An answer in short.

    Attributes:
        test: the task's number or name.
        mode: as in ``Options``.
        discount: exact.
        status: as in ``Result``, or ``error``: the task, or this call, is broken.
        cost: of the answer, or None.
        human_cost: of the human's plan, or None.
        opportunity: whether a robot helps.
        window: of the answer, or None.
        seconds: wall time of the planning call, without reading the task.
        best_tie: least cost over the human's optimal plans; ``cost`` where that is no question,
            None where a limit came before it was known.
        worst_tie: greatest cost over them.
        reason: of an ``error``.
    """

    test: str
    mode: str
    discount: Fraction
    status: str
    cost: Fraction | None
    human_cost: Fraction | None
    opportunity: bool
    window: Window | None
    seconds: float
    best_tie: Fraction | None
    worst_tie: Fraction | None
    reason: str | None = None

    @property
    def proved(self) -> bool:
        """True if no limit came before the proof."""
        return self.status in ("optimal", "infeasible")

    def cells(self) -> tuple[str, ...]:
        """The texts of ``COLUMNS``; empty where there is no value."""
        told = self.to_dict() | ({"seconds": None} if self.status == "error" else {})
        return tuple(_cell(name, value) for name, value in told.items())

    def to_dict(self) -> dict[str, Any]:
        """The JSON object, in the order of ``COLUMNS``."""
        plain = {name: getattr(self, name, None) for name in COLUMNS} | {"discount": float(self.discount)}
        if self.window is not None:
            plain |= {"window_start": self.window.start, "window_end": self.window.end}
        return plain | {name: rounded(plain[name]) for name in _COSTS}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> "Row":
        """The row that :meth:`to_dict` wrote."""
        plain = {name: data[name] for name in ("test", "mode", "status", "opportunity", "seconds")}
        costs: dict[str, Any] = {name: exact_cost(data[name]) for name in _COSTS}
        start = data["window_start"]
        window = None if start is None else Window(start, data["window_end"])
        discount = as_written(data["discount"])
        return cls(**plain, **costs, discount=discount, window=window, reason=data.get("reason"))


def exact_cost(value: float | None) -> Fraction | None:
    """The rational that a cost in a result stands for."""
    return None if value is None else as_written(value)


def _cell(name: str, value: str | float | None) -> str:
    if value is None:
        return ""
    if not isinstance(value, float):
        return str(value)
    text = f"{value:.6f}" if name == "seconds" else str(float(value))
    return text.removesuffix(".0") if name == "discount" else text
