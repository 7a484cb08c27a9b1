"""What bodies do for an action: they walk, take, lay down and hand over, moment by moment.

A deed is a generator: each ``next`` is a moment, after which the engine makes a step.
"""

from collections.abc import Generator, Iterable
from math import hypot
from typing import Final

from serendipity.robot.physics.building import Point
from serendipity.robot.physics.engine import RATE
from serendipity.robot.physics.figure import Kit, Walker

Deed = Generator[None, None, None]

WORK: Final = 2.7
"""Seconds for what is neither a walk nor about a thing."""

_OVER: Final = object()
_PATIENCE: Final = 3.0
"""Seconds without getting any nearer after which a way is given up."""
_PROGRESS: Final = 0.01
_HANDLING: Final = 0.8  # seconds to take something or to lay it down, before and after
_ARM: Final = 0.26  # how near to something one stands who takes it, in metres
_FACING: Final = 0.42  # how far apart two stand who hand something over


class StuckError(Exception):
    """A body can't do what it should; it says why."""


def walk(figure: Walker, speed: float, point: Point, target: str) -> Deed:
    """Walk to a point in or near something; a StuckError where something is in the way."""
    nearest, waited = figure.away(point), 0
    while not figure.walk(point, speed):
        yield
        waited += 1
        if (away := figure.away(point)) < nearest - _PROGRESS:
            nearest, waited = away, 0
        elif waited > _PATIENCE * RATE:
            raise StuckError(f"stuck on the way to {target}")


def take(figure: Walker, speed: float, kit: Kit) -> Deed:
    """Pick something up from the floor."""
    place = kit.place[:2]
    if figure.away(place) > _ARM:
        yield from walk(figure, speed, _towards(place, figure.at, _ARM), "it")
    yield from wait([figure], _HANDLING, place)
    kit.take(figure)
    yield from wait([figure], _HANDLING)


def put(figure: Walker, kit: Kit) -> Deed:
    """Lay something down."""
    yield from wait([figure], _HANDLING)
    kit.let_go()
    yield from wait([figure], _HANDLING)


def hand(giver: Walker, taker: Walker, speed: float, kit: Kit) -> Deed:
    """Hand something over."""
    if giver.away(taker.at) > _FACING:
        for _ in walk(taker, speed, _towards(giver.at, taker.at, _FACING), "the other"):
            giver.rest(taker.at)
            yield
    yield from together([wait([giver], _HANDLING, taker.at), wait([taker], _HANDLING, giver.at)])
    kit.take(taker)
    yield from wait([giver, taker], _HANDLING / 2)


def wait(figures: Iterable[Walker], seconds: float, facing: Point | None = None) -> Deed:
    """Be busy where one is."""
    everybody = list(figures)
    for _ in range(round(seconds * RATE)):
        for figure in everybody:
            figure.rest(facing)
        yield


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


def _towards(point: Point, other: Point, metres: float) -> Point:
    """The point that is so far from one point, on the way to another one."""
    share = metres / hypot(other[0] - point[0], other[1] - point[1])
    return point[0] + (other[0] - point[0]) * share, point[1] + (other[1] - point[1]) * share
