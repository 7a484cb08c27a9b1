"""Heat maps over the start and the end of windows."""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Final

from serendipity.model import Window
from serendipity.pictures.picture.drawing import (
    INK,
    PAPER,
    WALL,
    Picture,
    Rect,
    Shape,
    ShapeGroup,
    Style,
    Text,
)

Savings = Mapping[Window, Fraction | None]
"""What is saved in each window; None where no plan fits."""

_CELL: Final = 34
_LEFT: Final = 110
_TOP: Final = 84
_GAP: Final = 60
_SIZE: Final = 12
_LOW: Final = (255, 255, 255)
_HIGH: Final = (0, 90, 160)
"""Light to dark blue: the order is the same in grey."""
_UNFIT: Final = "#c8cdd3"


def heat_map(maps: Mapping[str, Savings], starts: int, horizon: int) -> Picture:
    """Maps beside each other, by what stands above them.

    Grey cells are windows that no plan fits; where none is, a limit came before it was examined.
    """
    width = _LEFT + horizon * _CELL + _GAP
    groups = tuple(
        ShapeGroup(tuple(_map(title, savings, starts, horizon)), x=i * width)
        for i, (title, savings) in enumerate(maps.items())
    )
    return Picture(len(maps) * width, _TOP + starts * _CELL + 24, groups, "Savings by window")


def _map(title: str, savings: Savings, starts: int, horizon: int) -> Iterator[Shape]:
    most = max((value for value in savings.values() if value is not None), default=Fraction(0))
    yield Text(_LEFT, 20, title, _SIZE + 2, anchor="start", bold=True)
    yield Text(_LEFT, 44, "first epoch after the window", _SIZE, anchor="start")
    yield Text(_LEFT - 8, _TOP - 12, "first epoch", _SIZE, anchor="end")
    for end in range(2, horizon + 2):
        yield Text(_LEFT + (end - 1.5) * _CELL, _TOP - 12, str(end), _SIZE)
    for start in range(1, starts + 1):
        yield Text(_LEFT - 8, _TOP + (start - 0.5) * _CELL, str(start), _SIZE, anchor="end")
    for window, value in savings.items():
        x, y = _LEFT + (window.end - 2) * _CELL, _TOP + (window.start - 1) * _CELL
        yield _cell(x, y, value, most, f"[{window.start}, {window.end})")


def _cell(x: int, y: int, value: Fraction | None, most: Fraction, window: str) -> ShapeGroup:
    share = float(value / most) if value is not None and value > 0 else 0.0
    side = _CELL - 2
    mixed = bytes(round(low + share * (high - low)) for low, high in zip(_LOW, _HIGH, strict=True))
    colour = _UNFIT if value is None else f"#{mixed.hex()}"
    label = "" if value is None else f"{float(value):.3g}"
    shown = "no plan fits" if value is None else f"saves {label}"
    return ShapeGroup(
        (
            Rect(x, y, side, side, Style(fill=colour, stroke=WALL)),
            Text(x + side / 2, y + side / 2, label, _SIZE, colour=PAPER if share > 0.5 else INK),
        ),
        title=f"{window}: {shown}",
    )
