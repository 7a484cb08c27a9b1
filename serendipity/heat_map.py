"""The interruptibility report as a heat map over the window's start and end, in SVG."""

from collections.abc import Callable
from fractions import Fraction
from html import escape
from typing import Final

from serendipity.interruptibility import Interruption, InterruptionReport

_CELL, _LEFT, _TOP, _GAP = 34, 64, 76, 90
_LOW: Final = (255, 255, 255)
_HIGH: Final = (0, 90, 160)
"""Light to dark blue: the order is the same in grey."""


def heat_map(report: InterruptionReport) -> str:
    """Two maps beside each other: what he saves, and what the team saves, by window."""
    horizon = report.horizon or 0
    starts = len(report.human_plan or ())
    width = _LEFT + horizon * _CELL + _GAP
    height = _TOP + starts * _CELL + 56
    maps = [
        _map(report, f"{report.human} saves at most", lambda entry: entry.human_saving),
        _map(report, "the team saves at most", lambda entry: entry.team_saving),
    ]
    body = "".join(f'<g transform="translate({i * width} 0)">{part}</g>' for i, part in enumerate(maps))
    title = "Savings by window"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {2 * width} {height}" width="{2 * width}" '
        f'height="{height}" role="img" font-family="sans-serif" font-size="12"><title>{title}</title>'
        f'<rect width="100%" height="100%" fill="#fff"/>{body}</svg>\n'
    )


def _map(report: InterruptionReport, title: str, saving: Callable[[Interruption], Fraction | None]) -> str:
    values = {entry.window: saving(entry) for entry in report.windows}
    most = max((value for value in values.values() if value is not None), default=Fraction(0))
    horizon, starts = report.horizon or 0, len(report.human_plan or ())
    parts = [_text(_LEFT, 24, title, "start", bold=True)]
    parts.append(_text(_LEFT, 44, "end of the window (first epoch after it)", "start"))
    middle = _TOP + starts * _CELL / 2
    parts.append(f'<g transform="rotate(-90 18 {middle})">{_text(18, middle, "first epoch", "middle")}</g>')
    for end in range(2, horizon + 2):
        parts.append(_text(_LEFT + (end - 1.5) * _CELL, _TOP - 8, str(end), "middle"))
    for start in range(1, starts + 1):
        parts.append(_text(_LEFT - 8, _TOP + (start - 0.5) * _CELL + 4, str(start), "end"))
    for window, value in values.items():
        x, y = _LEFT + (window.end - 2) * _CELL, _TOP + (window.start - 1) * _CELL
        parts.append(_cell(x, y, value, most, f"[{window.start}, {window.end})"))
    return "".join(parts)


def _cell(x: int, y: int, value: Fraction | None, most: Fraction, window: str) -> str:
    share = float(value / most) if value is not None and value > 0 else 0.0
    colour = "#bbb" if value is None else _mixed(share)
    label = "" if value is None else f"{float(value):.3g}"
    ink = "#fff" if share > 0.5 else "#000"
    shown = "no plan fits" if value is None else f"saves {label}"
    return (
        f'<g><title>{window}: {shown}</title><rect x="{x}" y="{y}" width="{_CELL - 2}" height="{_CELL - 2}" '
        f'fill="{colour}" stroke="#999"/>'
        + _text(x + _CELL / 2 - 1, y + _CELL / 2 + 3, label, "middle", colour=ink)
        + "</g>"
    )


def _mixed(share: float) -> str:
    channels = (round(low + share * (high - low)) for low, high in zip(_LOW, _HIGH, strict=True))
    return "#" + "".join(f"{channel:02x}" for channel in channels)


def _text(x: float, y: float, text: str, anchor: str, *, bold: bool = False, colour: str = "#000") -> str:
    weight = ' font-weight="bold"' if bold else ""
    return f'<text x="{x}" y="{y}" text-anchor="{anchor}" fill="{colour}"{weight}>{escape(text)}</text>'
