"""Small charts as inline SVG: lines and grouped bars.

Series are told apart by colour (the Okabe-Ito palette), by dashes and by their names.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, floor, log10
from typing import Final

from serendipity.model.printable import markup

_WIDTH, _HEIGHT = 700, 360
_LEFT, _RIGHT, _TOP, _BOTTOM = 64, 210, 40, 52
_COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
_DASHES: Final = ("", "7 4", "2 3", "9 3 2 3", "4 2", "1 2")

Points = Sequence[tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Labels:
    """What a chart says: its title, and what its axes show."""

    title: str
    x: str
    y: str


def lines(labels: Labels, series: Mapping[str, Points], *, log_x: bool = False) -> str:
    """A line chart; with ``log_x`` the horizontal axis is logarithmic."""
    points = [point for values in series.values() for point in values]
    x_axis = _Axis.of([x for x, _ in points], _LEFT, _WIDTH - _RIGHT, logarithmic=log_x)
    y_axis = _Axis.of([y for _, y in points], _HEIGHT - _BOTTOM, _TOP)
    parts = _frame(labels, x_axis, y_axis)
    for i, (name, values) in enumerate(series.items()):
        colour, dash = _COLOURS[i % len(_COLOURS)], _DASHES[i % len(_DASHES)]
        path = " ".join(f"{x_axis.at(x):.1f},{y_axis.at(y):.1f}" for x, y in values)
        parts.append(
            f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2" '
            f'stroke-dasharray="{dash}"/>'
        )
        parts += _legend(i, name, colour, dash)
    return _svg(labels, parts)


def bars(labels: Labels, groups: Sequence[str], series: Mapping[str, Sequence[float]]) -> str:
    """Bars side by side: for each group one of each series."""
    top = max((value for values in series.values() for value in values), default=1)
    y_axis = _Axis.of([0, top], _HEIGHT - _BOTTOM, _TOP)
    parts = _frame(labels, None, y_axis)
    room = (_WIDTH - _LEFT - _RIGHT) / max(1, len(groups))
    width = room * 0.8 / max(1, len(series))
    for g, group in enumerate(groups):
        left = _LEFT + g * room
        parts.append(_text(left + room / 2, _HEIGHT - _BOTTOM + 18, group, "middle"))
        for i, values in enumerate(series.values()):
            y = y_axis.at(values[g])
            parts.append(
                f'<rect x="{left + room * 0.1 + i * width:.1f}" y="{y:.1f}" width="{width:.1f}" '
                f'height="{_HEIGHT - _BOTTOM - y:.1f}" fill="{_COLOURS[i % len(_COLOURS)]}"/>'
            )
    for i, name in enumerate(series):
        parts += _legend(i, name, _COLOURS[i % len(_COLOURS)], "")
    return _svg(labels, parts)


@dataclass(frozen=True, slots=True)
class _Axis:
    low: float
    high: float
    start: float
    end: float
    ticks: tuple[float, ...]
    logarithmic: bool = False

    @classmethod
    def of(cls, values: Sequence[float], start: float, end: float, *, logarithmic: bool = False) -> "_Axis":
        """An axis from pixel ``start`` to ``end`` that covers the values; counts have whole ticks."""
        low, high = min(values, default=0.0), max(values, default=1.0)
        if logarithmic:
            first, last = floor(log10(low)), ceil(log10(high))
            ticks = tuple(10.0**power for power in range(first, max(last, first + 1) + 1))
            return cls(ticks[0], ticks[-1], start, end, ticks, logarithmic=True)
        step = _step((high - low) or 1.0)
        if all(isinstance(value, int) for value in values):  # nobody has half a task
            step = max(step, 1.0)
        first, last = floor(low / step), max(ceil(high / step), floor(low / step) + 1)
        ticks = tuple(i * step for i in range(first, last + 1))
        return cls(ticks[0], ticks[-1], start, end, ticks)

    def at(self, value: float) -> float:
        """The pixel of a value."""
        if self.logarithmic:
            share = (log10(value) - log10(self.low)) / (log10(self.high) - log10(self.low))
        else:
            share = (value - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)


def _step(span: float) -> float:
    """A round distance that cuts a span into about five."""
    power = 10.0 ** floor(log10(span / 5))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power >= span / 5)


def _frame(labels: Labels, x_axis: _Axis | None, y_axis: _Axis) -> list[str]:
    right, bottom = _WIDTH - _RIGHT, _HEIGHT - _BOTTOM
    parts = [
        _text(_LEFT, 22, labels.title, "start", weight="bold"),
        _text((_LEFT + right) / 2, _HEIGHT - 10, labels.x, "middle"),
        f'<g transform="rotate(-90 16 {(_TOP + bottom) / 2})">'
        + _text(16, (_TOP + bottom) / 2, labels.y, "middle")
        + "</g>",
        f'<path d="M{_LEFT} {_TOP}V{bottom}H{right}" fill="none" stroke="currentColor"/>',
    ]
    for tick in y_axis.ticks:
        y = y_axis.at(tick)
        parts.append(f'<path d="M{_LEFT} {y:.1f}H{right}" stroke="currentColor" opacity="0.15"/>')
        parts.append(_text(_LEFT - 6, y + 4, f"{tick:.6g}", "end"))
    for tick in x_axis.ticks if x_axis else ():
        assert x_axis is not None
        parts.append(_text(x_axis.at(tick), bottom + 18, f"{tick:.6g}", "middle"))
    return parts


def _legend(index: int, name: str, colour: str, dash: str) -> list[str]:
    x, y = _WIDTH - _RIGHT + 14, _TOP + 12 + 20 * index
    return [
        f'<path d="M{x} {y - 4}h22" stroke="{colour}" stroke-width="3" stroke-dasharray="{dash}"/>',
        _text(x + 28, y, name, "start"),
    ]


def _text(x: float, y: float, text: str, anchor: str, *, weight: str = "normal") -> str:
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-weight="{weight}" '
        f'fill="currentColor">{markup(text)}</text>'
    )


def _svg(labels: Labels, parts: Sequence[str]) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" '
        f'aria-label="{markup(labels.title)}" font-family="sans-serif" font-size="12">'
        f"<title>{markup(labels.title)}</title>" + "".join(parts) + "</svg>"
    )
