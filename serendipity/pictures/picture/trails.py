"""The ways that agents go, as lines beside each other: each keeps to its own lane, on the right."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot
from typing import Final

from serendipity.pictures.map.layout import Layout
from serendipity.pictures.picture.drawing import Point

LANE: Final = 7.0
"""Distance between neighbouring lanes, in the picture's units."""


def trail(layout: Layout, stops: Sequence[str | None], lane: float) -> tuple[tuple[Point, ...], ...]:
    """The points that each step adds to the line of an agent.

    Args:
        layout: of the map.
        stops: its place after each epoch, from 0; None while it is nowhere.
        lane: from 1; how many lanes to the right of the middle; fractions lie between.

    Returns:
        for each epoch the points that its step adds; none where it stays.
    """
    found: list[tuple[Point, ...]] = [()]
    for here, there in pairwise(stops):
        if here is None or there is None or here == there:
            found.append(())
        else:
            found.append(tuple(_beside(layout.route(here, there), lane * LANE)))
    return tuple(found)


def _beside(route: Sequence[Point], offset: float) -> Iterator[Point]:
    for (x1, y1), (x2, y2) in pairwise(route):
        length = hypot(x2 - x1, y2 - y1)
        if length:
            dx, dy = -(y2 - y1) / length * offset, (x2 - x1) / length * offset
            yield x1 + dx, y1 + dy
            yield x2 + dx, y2 + dy
