"""A picture as a list of shapes, whoever paints it: SVG by hand, PNG by matplotlib.

Units are pixels at natural size, ``y`` grows downwards.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from serendipity.pictures.map.names import ems, shortened
from serendipity.pictures.picture.palette import INK

BOLD: Final = 1.1
"""How much wider bold letters are than others."""

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Style:
    """How a shape is painted; ``fill`` or ``stroke`` None: not at all."""

    fill: str | None = None
    stroke: str | None = None
    width: float = 1.0
    dash: tuple[float, ...] = ()
    opacity: float = 1.0


@dataclass(frozen=True, slots=True)
class Rect:
    """A rectangle with corners of radius ``round``; (x, y) is its upper left corner."""

    x: float
    y: float
    width: float
    height: float
    style: Style
    round: float = 0.0


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle about (x, y)."""

    x: float
    y: float
    radius: float
    style: Style


@dataclass(frozen=True, slots=True)
class Polyline:
    """A line through points; ``closed`` makes a polygon."""

    points: tuple[Point, ...]
    style: Style
    closed: bool = False
    data: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Text:
    """One line of text about the height ``y`` of its middle."""

    x: float
    y: float
    text: str
    size: float
    colour: str = INK
    anchor: str = "middle"
    bold: bool = False


@dataclass(frozen=True, slots=True)
class Group:
    """Shapes that move together, with ``data-*`` attributes for a page's script."""

    shapes: "tuple[Shape, ...]"
    x: float = 0.0
    y: float = 0.0
    data: Mapping[str, str] = field(default_factory=dict)
    title: str = ""
    opacity: float = 1.0


Shape = Rect | Circle | Polyline | Text | Group


@dataclass(frozen=True, slots=True)
class Picture:
    """Shapes on a sheet of a size, and what they show in words."""

    width: float
    height: float
    shapes: tuple[Shape, ...]
    description: str


def fitted(text: str, width: float, size: float, least: float, *, bold: bool = False) -> tuple[str, float]:
    """A text and the font size at which it fits into a width; shortened below ``least``.

    Args:
        width: in pixels.
        size: font size to begin with, in pixels.
        least: the smallest font size.
        bold: whether the font is bold.
    """
    room = width / (BOLD if bold else 1)
    wanted = min(size, room / max(0.1, ems(text)))
    if wanted >= least:
        return text, wanted
    return shortened(text, room / least), least


def wrapped(
    text: str, width: float, sizes: Sequence[float], lines: int = 2, *, bold: bool = False
) -> tuple[tuple[str, ...], float]:
    """A text in few lines of a width, and its font size; at the last size it is shortened where it must be.

    Args:
        text: the text; it is broken at blanks and after ``_`` and ``-``.
        width: in pixels.
        sizes: font sizes, the best one first, in pixels.
        lines: at most so many.
        bold: whether the font is bold.
    """
    for size in sizes:
        room = width / size / (BOLD if bold else 1)
        found = [""]
        for word in re.split(r" |(?<=[_-])", text):
            gap = " " if found[-1] and found[-1][-1] not in "_-" else ""
            if found[-1] and ems(found[-1] + gap + word) > room and len(found) < lines:
                found.append(word)
            else:
                found[-1] += gap + word
        if max(map(ems, found)) <= room:
            break
    return tuple(shortened(line, room) for line in found), size
