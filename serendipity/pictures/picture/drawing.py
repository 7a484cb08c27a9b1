"""A picture as a list of shapes and colours, whoever paints it: SVG by hand, PNG by matplotlib.

Units are pixels at natural size, ``y`` grows downwards.  Colours are those that colour-blind people can tell
apart (Okabe and Ito 2008).  Nothing is told by colour alone: agents also differ in shape and letter, the
former plan in its dashes, the window in its label.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from serendipity.pictures.map.names import ems, shortened

BLACK: Final = "#000000"
ORANGE: Final = "#E69F00"
SKY: Final = "#56B4E9"
GREEN: Final = "#009E73"
BLUE: Final = "#0072B2"
VERMILLION: Final = "#D55E00"
PURPLE: Final = "#CC79A7"

INK: Final = "#1f2328"
FAINT_INK: Final = "#57606a"
PAPER: Final = "#ffffff"
FLOOR: Final = "#f3f5f7"
CORRIDOR: Final = "#e4e8ec"
WALL: Final = "#8b949e"
WINDOW: Final = "#fbf3ad"  # yellow, let down with white
MEETING: Final = PURPLE
GOAL: Final = GREEN
FORMER: Final = "#6e7781"

HUMAN: Final = BLUE
ROBOTS: Final = (VERMILLION, GREEN, ORANGE, SKY, BLACK)


def agent_colours(agents: int, human: int) -> dict[int, str]:
    """The colour of each agent; robots beyond the fifth share colours, not letters."""
    robots = [i for i in range(agents) if i != human]
    return {human: HUMAN} | {agent: ROBOTS[n % len(ROBOTS)] for n, agent in enumerate(robots)}


def on(colour: str) -> str:
    """Black or white, whichever reads better on a colour (WCAG relative luminance)."""
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    return PAPER if luminance < 0.25 else INK


def tint(colour: str, share: float = 0.16) -> str:
    """A colour let down with white."""
    channels = [int(colour[i : i + 2], 16) for i in (1, 3, 5)]
    return "#" + "".join(f"{round(255 - (255 - c) * share):02x}" for c in channels)


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
class ShapeGroup:
    """Shapes that move together, with ``data-*`` attributes for a page's script."""

    shapes: "tuple[Shape, ...]"
    x: float = 0.0
    y: float = 0.0
    data: Mapping[str, str] = field(default_factory=dict)
    title: str = ""


Shape = Rect | Circle | Polyline | Text | ShapeGroup


@dataclass(frozen=True, slots=True)
class Picture:
    """Shapes on a sheet of a size, and what they show in words."""

    width: float
    height: float
    shapes: tuple[Shape, ...]
    description: str


def fitted(text: str, width: float, size: float, least: float, *, bold: bool = False) -> tuple[str, float]:
    """A text and the font size at which it fits into a width in pixels; shortened below ``least``."""
    room = width / (BOLD if bold else 1)
    wanted = min(size, room / max(0.1, ems(text)))
    if wanted >= least:
        return text, wanted
    return shortened(text, room / least), least


def wrapped(
    text: str, width: float, sizes: Sequence[float], lines: int = 2, *, bold: bool = False
) -> tuple[tuple[str, ...], float]:
    """A text in few lines of a width, broken at blanks, ``_`` and ``-``, in the first font size that does."""
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


def act_style(colour: str, joint: bool) -> Style:
    """How the box of an action is painted."""
    return Style(tint(colour), MEETING if joint else colour, 3.5 if joint else 1.5)


def box(
    verb: str, detail: str, width: float, middle: float, height: float, paint: Style, ink: str
) -> Iterator[Shape]:
    """A box with an action in two to four lines, the detail, which tells it from others, in bold."""
    inner = width - 8
    first, small = wrapped(verb, inner - 4, (13, 12, 11))
    rest, large = wrapped(detail, inner - 6, (14, 12, 11, 10, 9), 4 - len(first), bold=True)
    lines = [(line, small, False) for line in first] + [(line, large, True) for line in rest if line]
    heights = stacked(len(lines), middle, min(16, (height - 4) / len(lines)))
    yield Rect(4, middle - height / 2, inner, height, paint, round=8)
    for (line, size, bold), y in zip(lines, heights, strict=True):
        yield Text(width / 2, y, line, size, ink, bold=bold)


def stacked(lines: int, middle: float, step: float) -> list[float]:
    """Heights of lines about a middle."""
    return [middle + (i - (lines - 1) / 2) * step for i in range(lines)]
