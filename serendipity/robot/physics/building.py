"""The miniature building: cells of a floor plan as rooms with walls and open doorways."""

from collections.abc import Iterator
from typing import Final

from serendipity.pictures.map.layout import Box, MapLayout
from serendipity.robot.physics.engine import Colour, Engine

CELL: Final = 0.8
"""Least side of a room, in metres."""

_GAP: Final = 0.42  # how wide a doorway is, in metres
_NEAR: Final = 0.24  # from a doorway to where it is approached
_WALL: Final = 0.16, 0.04  # height and thickness
_HALL: Final[Colour] = (0.87, 0.85, 0.79, 1)
_ROOM: Final[Colour] = (0.94, 0.94, 0.93, 1)
_BRICK: Final[Colour] = (0.62, 0.66, 0.72, 1)

Point = tuple[float, float]


class Rooms:
    """Rooms on a floor.

    Args:
        layout: of the map; ``y`` of pictures grows downwards, that of the building away from who looks.

    Attributes:
        middles: the middle of each place, in metres.
        corners: its corner at the left, nearest to who looks.
        width, depth: of the whole, in metres.
    """

    def __init__(self, engine: Engine, layout: MapLayout) -> None:
        self._engine = engine
        self._layout = layout
        self._scale = CELL / min(side for box in layout.boxes.values() for side in (box.width, box.height))
        self.width, self.depth = layout.width * self._scale, layout.height * self._scale
        boxes = layout.boxes.items()
        self.corners = {place: self._at(box.left, box.bottom) for place, box in boxes}
        self.middles = {place: self._at(box.x, box.y) for place, box in boxes}
        ground = (self.width + 4, self.depth + 4, 0.1)
        engine.box(ground, (self.width / 2, self.depth / 2, -0.06), (1, 1, 1, 1))
        for place, box in boxes:
            size = (box.width * self._scale, box.height * self._scale, 0.01)
            engine.box(size, (*self.middles[place], -0.005), _HALL if box.corridor else _ROOM, solid=False)
        for start, end in self._walls():
            self._brick(start, end)

    def way(self, source: str, target: str) -> tuple[Point, ...]:
        """The points on the way between two places that share a doorway: before it, in it, behind it."""
        boxes = self._layout.boxes
        shared = not self._layout.doors.isdisjoint(((source, target), (target, source)))
        if not shared or (boxes[source].corridor and boxes[target].corridor):
            return ()
        middle, upright = self._layout.doorway(source, target)
        x, y = self._at(*middle)
        ahead = self.middles[target]
        dx = _NEAR * (1 if ahead[0] > x else -1) if upright else 0.0
        dy = 0.0 if upright else _NEAR * (1 if ahead[1] > y else -1)
        return (x - dx, y - dy), (x, y), (x + dx, y + dy)

    def place_at(self, point: Point) -> str:
        """The place whose middle is nearest, counted in its own sides."""

        def off(place: str) -> float:
            (x, y), box = self.middles[place], self._layout.boxes[place]
            return max(abs(point[0] - x) / box.width, abs(point[1] - y) / box.height)

        return min(self.middles, key=off)

    def _at(self, x: float, y: float) -> Point:
        return x * self._scale, self.depth - y * self._scale

    def _walls(self) -> Iterator[tuple[Point, Point]]:
        """Pieces of wall from point to point, in metres; a doorway is between two of them."""
        boxes = self._layout.boxes
        openings: dict[tuple[float, float, bool], bool] = {}
        for a, b in self._layout.doors:
            (x, y), upright = self._layout.doorway(a, b)
            openings[round(x, 3), round(y, 3), upright] = boxes[a].corridor and boxes[b].corridor
        sides = [side for box in boxes.values() for side in _sides(box)]
        for start, end in {tuple(round(v, 3) for v in (*a, *b)): (a, b) for a, b in sides}.values():
            yield from self._pieces(start, end, openings)

    def _pieces(
        self, start: Point, end: Point, openings: dict[tuple[float, float, bool], bool]
    ) -> Iterator[tuple[Point, Point]]:
        axis = 1 if start[0] == end[0] else 0
        on = [
            ((x, y), wide)
            for (x, y, upright), wide in openings.items()
            if upright is bool(axis)
            and (start[0] - 0.01 <= x <= end[0] + 0.01)
            and (start[1] - 0.01 <= y <= end[1] + 0.01)
        ]
        if any(wide for _, wide in on):
            return
        a, b = self._at(*start), self._at(*end)
        direction = 1 if b[axis] > a[axis] else -1
        for middle in sorted((self._at(*at) for at, _ in on), key=lambda point: direction * point[axis]):
            near, far = list(middle), list(middle)
            near[axis] -= direction * _GAP / 2
            far[axis] += direction * _GAP / 2
            yield a, (near[0], near[1])
            a = far[0], far[1]
        yield a, b

    def _brick(self, start: Point, end: Point) -> None:
        height, thick = _WALL
        size = (abs(end[0] - start[0]) + thick, abs(end[1] - start[1]) + thick, height)
        middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, height / 2)
        self._engine.box(size, middle, _BRICK)


def _sides(box: Box) -> Iterator[tuple[Point, Point]]:
    for y in (box.top, box.bottom):
        yield (box.left, y), (box.right, y)
    for x in (box.left, box.right):
        yield (x, box.top), (x, box.bottom)
