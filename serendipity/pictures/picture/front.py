"""The front of disturbance and saving as steps with a mark for each point."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Final

from serendipity.pictures.picture.drawing import (
    BLUE,
    FAINT_INK,
    INK,
    PAPER,
    Circle,
    Picture,
    Point,
    Polyline,
    Rect,
    Shape,
    ShapeGroup,
    Style,
    Text,
)

_WIDTH: Final = 420
_HEIGHT: Final = 260
_LEFT: Final = 70
_TOP: Final = 30
_SIZE: Final = 12


def front_picture(points: Sequence[tuple[Fraction, Fraction]]) -> Picture:
    """Saving over disturbance, of points where both rise."""
    widest = max([Fraction(1), *(x for x, _ in points)])
    highest = max([Fraction(1, 10**9), *(y for _, y in points)])

    def place(x: Fraction, y: Fraction) -> Point:
        return _LEFT + float(x / widest) * _WIDTH, _TOP + _HEIGHT - float(y / highest) * _HEIGHT

    corners: list[Point] = []
    for x, y in points:
        here = place(x, y)
        corners += [(here[0], corners[-1][1]), here] if corners else [here]
    if corners:
        corners.append((_LEFT + _WIDTH + 20, corners[-1][1]))
    axes = ((_LEFT, _TOP - 10), (_LEFT, _TOP + _HEIGHT), (_LEFT + _WIDTH + 20, _TOP + _HEIGHT))
    shapes: list[Shape] = [
        Rect(0, 0, _LEFT + _WIDTH + 60, _TOP + _HEIGHT + 60, Style(fill=PAPER)),
        Polyline(axes, Style(stroke=FAINT_INK)),
        Text(_LEFT + _WIDTH / 2, _TOP + _HEIGHT + 44, "disturbance", _SIZE),
        Text(_LEFT, _TOP - 20, "saving", _SIZE),
        Polyline(tuple(corners), Style(stroke=BLUE, width=1.5)),
    ]
    for x, y in points:
        at = place(x, y)
        shapes += [
            ShapeGroup(
                (Circle(*at, 5, Style(fill=BLUE)),),
                title=f"disturbance {float(x):g}: saves {float(y):g}",
            ),
            Text(at[0], _TOP + _HEIGHT + 16, f"{float(x):g}", _SIZE, colour=INK),
            Text(_LEFT - 8, at[1], f"{float(y):g}", _SIZE, anchor="end", colour=INK),
        ]
    return Picture(_LEFT + _WIDTH + 60, _TOP + _HEIGHT + 60, tuple(shapes), "Saving against disturbance")
