"""Bodies: figures that a force leads about, and things that they take and hand over.

Figures are of the size of a Nao, and look like pieces of a board game.
"""

from math import atan2, hypot, pi
from typing import Final

from serendipity.robot.physics.building import Point
from serendipity.robot.physics.engine import RATE, Colour, Engine, Vector

_RADIUS: Final = 0.11  # of the room that a figure takes, in metres
_HEIGHT: Final = 0.44  # without its head
_HEAD: Final = 0.065
_MASS: Final = 4.0
_PULL: Final = 48.0
"""The most force that leads a figure, in newtons: what weighs more than that stays where it is."""
_LEASH: Final = 0.08  # how far ahead of it the point may be that leads it, in metres
_TURN: Final = 5.0  # radians in a second
_CLOSE: Final = 0.02  # metres


class Walker:
    """A body that walks, and its number in the engine."""

    def __init__(self, engine: Engine, at: Point, colour: Colour, cap: Colour) -> None:
        self._engine = engine
        head = engine.look("SPHERE", cap, radius=_HEAD)
        nose = engine.look("BOX", cap, halfExtents=(0.03, 0.05, 0.1))
        look = engine.look("CAPSULE", colour, radius=0.07, length=_HEIGHT - 0.14)
        solid = engine.solid("CYLINDER", radius=_RADIUS, height=_HEIGHT - 0.04)
        parts = [(head, (0.0, 0.0, _HEIGHT / 2 + _HEAD)), (nose, (0.05, 0.0, 0.02))]
        self.body = engine.body(_MASS, solid, look, (*at, _HEIGHT / 2), parts)
        self._lead, self._heading = at, -pi / 2
        fixed, origin = engine.bullet.JOINT_FIXED, (0, 0, 0)
        led = (self.body, -1, -1, -1, fixed, origin, origin, (*at, _HEIGHT / 2))
        self._leash = engine.call("createConstraint", *led)

    @property
    def at(self) -> Point:
        """Where it is on the floor."""
        x, y, _ = self._engine.place_of(self.body)
        return x, y

    @property
    def top(self) -> Vector:
        """Above its head."""
        return (*self.at, _HEIGHT + 2.6 * _HEAD)

    def away(self, target: Point) -> float:
        """Metres to a point on the floor."""
        x, y = self.at
        return hypot(target[0] - x, target[1] - y)

    def walk(self, target: Point, speed: float) -> bool:
        """Lead it towards a point for a moment, at metres a second; whether it is there."""
        left = self.away(target)
        if left < _CLOSE:
            self.rest()
            return True
        x, y = self.at
        ahead = min(left, _LEASH, speed / RATE + hypot(self._lead[0] - x, self._lead[1] - y))
        self._lead = x + (target[0] - x) / left * ahead, y + (target[1] - y) / left * ahead
        self.rest(target)
        return False

    def rest(self, facing: Point | None = None) -> None:
        """Stay where it is led to for a moment."""
        if facing is not None:
            x, y = self.at
            turn = (atan2(facing[1] - y, facing[0] - x) - self._heading + pi) % (2 * pi) - pi
            self._heading += max(-_TURN / RATE, min(_TURN / RATE, turn))
        turned = self._engine.call("getQuaternionFromEuler", (0, 0, self._heading))
        led = (self._leash, (*self._lead, _HEIGHT / 2), turned)
        self._engine.call("changeConstraint", *led, maxForce=_PULL)


_SIZE: Final[Vector] = (0.15, 0.11, 0.09)
_KIT_MASS: Final = 0.2
_GRIP: Final = 30.0
_HANDS: Final[Vector] = (0.18, 0.0, 0.05)
"""Where a figure holds things, from its middle."""
_RED: Final[Colour] = (0.88, 0.08, 0.1, 1)
_WHITE: Final[Colour] = (0.97, 0.97, 0.97, 1)
_BROWN: Final[Colour] = (0.72, 0.53, 0.34, 1)


class Kit:
    """A box, and who holds it, if anybody; a first-aid kit is red, with a cross on it."""

    def __init__(self, engine: Engine, at: Point, *, first_aid: bool) -> None:
        self._engine = engine
        half = [side / 2 for side in _SIZE]
        cross = [(0.05, 0.014, 0.006), (0.014, 0.042, 0.006)] if first_aid else []
        look = engine.look("BOX", _RED if first_aid else _BROWN, halfExtents=half)
        parts = [(engine.look("BOX", _WHITE, halfExtents=bar), (0.0, 0.0, half[2] + 0.004)) for bar in cross]
        solid = engine.solid("BOX", halfExtents=half)
        self._body = engine.body(_KIT_MASS, solid, look, (*at, half[2]), parts)
        self.holder: Walker | None = None
        self._grip = -1

    @property
    def place(self) -> Vector:
        """Where its middle is."""
        return self._engine.place_of(self._body)

    def take(self, figure: Walker) -> None:
        """Fix it between somebody's hands; whoever has held it lets go."""
        self.let_go()
        fixed, origin = self._engine.bullet.JOINT_FIXED, (0, 0, 0)
        held = (figure.body, -1, self._body, -1, fixed, origin, _HANDS, origin)
        self._grip = self._engine.call("createConstraint", *held)
        self._engine.call("changeConstraint", self._grip, maxForce=_GRIP)
        self._engine.call("setCollisionFilterGroupMask", self._body, -1, 0, 0)
        self.holder = figure

    def let_go(self) -> None:
        """Drop it, if anybody holds it."""
        if self.holder is not None:
            self._engine.call("removeConstraint", self._grip)
            self._engine.call("setCollisionFilterGroupMask", self._body, -1, 1, 1)
            self.holder = None

    def put(self, at: Point) -> None:
        """Lay it somewhere, whoever has held it."""
        self.let_go()
        lying = ((*at, _SIZE[2] / 2), (0, 0, 0, 1))
        self._engine.call("resetBasePositionAndOrientation", self._body, *lying)
