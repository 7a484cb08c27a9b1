"""A picture as a list of shapes, whoever paints it: SVG by hand, PNG by matplotlib.

Units are pixels at natural size, ``y`` grows downwards.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from serendipity.show.map.names import LETTER, elided
from serendipity.show.picture.palette import INK

BOLD_LETTER: Final = 0.66

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
class Line:
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


Shape = Rect | Circle | Line | Text | Group


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
        text: the text.
        width: in pixels.
        size: font size to begin with, in pixels.
        least: the smallest font size.
        bold: whether the font is bold.
    """
    letter = BOLD_LETTER if bold else LETTER
    wanted = min(size, width / max(1, len(text)) / letter)
    if wanted >= least:
        return text, wanted
    letters = max(1, int(width / least / letter))
    return elided(text, letters), least


def wrapped(text: str, width: float, size: float, lines: int = 2) -> tuple[str, ...]:
    """A text in at most ``lines`` lines of a width, broken at blanks and after ``_`` and ``-``.

    Args:
        text: the text.
        width: in pixels.
        size: font size, in pixels.
        lines: at most so many.
    """
    most = max(1, int(width / size / LETTER))
    found = [""]
    for word in re.split(r" |(?<=[_-])", text):
        gap = " " if found[-1] and found[-1][-1] not in "_-" else ""
        if found[-1] and len(found[-1]) + len(gap) + len(word) > most and len(found) < lines:
            found.append(word)
        else:
            found[-1] += gap + word
    return tuple(elided(line, most) for line in found)
