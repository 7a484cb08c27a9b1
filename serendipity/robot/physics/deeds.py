"""What bodies do for an action: they walk, kneel, take hold, and hand over, moment by moment.

A deed is a generator: each ``next`` is a moment, after which the engine makes a step.
"""

from collections.abc import Generator, Iterable, Sequence
from math import cos, hypot, sin
from typing import Final

from serendipity.robot.physics.building import Point, Rooms
from serendipity.robot.physics.engine import RATE, Engine
from serendipity.robot.physics.figure import KNEEL, REACH, STAND, Kit, Pose, StickFigure

Deed = Generator[None, None, None]

_OVER: Final = object()

_PATIENCE: Final = 3.0
"""Seconds without getting any nearer after which a way is given up."""
_PROGRESS: Final = 0.01
_DOWN: Final = 0.7  # seconds to kneel, and to get up again
_HOLDING: Final = 0.5
_WORK: Final = 2.0
_ARM: Final = 0.26  # how near to something one kneels, in metres
_FACING: Final = 0.42  # how far apart two stand who hand something over


class StuckError(Exception):
    """A body can't do what it should; it says why."""


class Bodies:
    """What figures can do in a building.

    Args:
        building: where they are.
    """

    def __init__(self, engine: Engine, building: Rooms) -> None:
        self._engine = engine
        self._building = building

    def go(self, figure: StickFigure, speed: float, target: str, spot: Point) -> Deed:
        """Walk to a spot in a place, from wherever one is.

        Raises:
            StuckError: something is in the way.
        """
        here = self._building.place_at(figure.at)
        points = self._building.way(here, target) if here != target else ()
        for point in (*points, spot):
            yield from self._walk(figure, speed, point, target)

    def take(self, figure: StickFigure, speed: float, kit: Kit) -> Deed:
        """Pick something up from the floor.

        Raises:
            StuckError: it is out of reach.
        """
        if figure.away(kit.place[:2]) > _ARM:
            yield from self._walk(figure, speed, _towards(kit.place[:2], figure.at, _ARM), "it")
        yield from _pose(figure, KNEEL, _DOWN, kit.place[:2])
        if not kit.within_reach(figure):
            raise StuckError("it is out of reach")
        kit.take(figure)
        yield from _pose(figure, KNEEL, _HOLDING / 2)
        yield from _pose(figure, STAND, _DOWN)

    def put(self, figure: StickFigure, kit: Kit) -> Deed:
        """Lay something down."""
        yield from _pose(figure, KNEEL, _DOWN)
        kit.let_go()
        yield from _pose(figure, STAND, _DOWN)

    def hand(self, giver: StickFigure, taker: StickFigure, speed: float, kit: Kit) -> Deed:
        """Hand something over.

        Raises:
            StuckError: they don't get near enough to each other.
        """
        if giver.away(taker.at) > _FACING:
            for _ in self._walk(taker, speed, _towards(giver.at, taker.at, _FACING), "the other"):
                giver.rest(facing=taker.at)
                yield
        for _ in _moments(_DOWN):
            giver.rest(REACH, taker.at)
            taker.rest(REACH, giver.at)
            yield
        if not kit.within_reach(taker):
            raise StuckError("their hands don't meet")
        kit.take(taker)
        for _ in _moments(_HOLDING):
            giver.rest(REACH, taker.at)
            taker.rest(REACH, giver.at)
            yield

    def work(self, figures: Sequence[StickFigure]) -> Deed:
        """Be busy where one is."""
        for pose, seconds in ((KNEEL, _WORK), (STAND, _DOWN)):
            yield from together([_pose(figure, pose, seconds) for figure in figures])

    def _walk(self, figure: StickFigure, speed: float, point: Point, target: str) -> Deed:
        nearest, since = figure.away(point), self._engine.seconds
        while not figure.walk(point, speed):
            yield
            away = figure.away(point)
            if away < nearest - _PROGRESS:
                nearest, since = away, self._engine.seconds
            elif self._engine.seconds - since > _PATIENCE:
                raise StuckError(f"stuck on the way to {target}")


def together(deeds: Iterable[Deed]) -> Deed:
    """Several deeds at the same time."""
    left = list(deeds)
    while left:
        left = [deed for deed in left if next(deed, _OVER) is not _OVER]
        if left:
            yield


def in_turn(deeds: Iterable[Deed]) -> Deed:
    """Several deeds, one after another."""
    for deed in deeds:
        yield from deed


def spot_of(middle: Point, number: int, of: int) -> Point:
    """Where in a place the one of that number stands, so that nobody is in anybody's way."""
    across = 0.22 * (2 * number / max(1, of - 1) - 1)
    along = -0.13 if number % 2 == 0 else 0.13
    return middle[0] + across, middle[1] + along


def shelf(middle: Point, number: int) -> Point:
    """Where in a place the thing of that number lies: round the edge."""
    angle = 0.7 + 1.1 * number
    radius = 0.3 / max(abs(cos(angle)), abs(sin(angle)), 0.75) * 0.75
    return middle[0] + radius * cos(angle), middle[1] + radius * sin(angle)


def _pose(figure: StickFigure, pose: Pose, seconds: float, facing: Sequence[float] | None = None) -> Deed:
    for _ in _moments(seconds):
        figure.rest(pose, None if facing is None else (facing[0], facing[1]))
        yield


def _moments(seconds: float) -> range:
    return range(round(seconds * RATE))


def _towards(point: Point, other: Point, metres: float) -> Point:
    """The point that is so far from one point, on the way to another one."""
    share = metres / hypot(other[0] - point[0], other[1] - point[1])
    return point[0] + (other[0] - point[0]) * share, point[1] + (other[1] - point[1]) * share
