"""Things that lie somewhere, are picked up and handed over."""

from math import dist
from typing import Final

from serendipity.robot.physics.building import Point
from serendipity.robot.physics.engine import Colour, Engine, Link, Vector
from serendipity.robot.physics.figure import PARTS, StickFigure

_SIZE: Final[Vector] = (0.15, 0.11, 0.09)
_MASS: Final = 0.2
_RED: Final[Colour] = (0.88, 0.08, 0.1, 1)
_WHITE: Final[Colour] = (0.97, 0.97, 0.97, 1)
_BROWN: Final[Colour] = (0.72, 0.53, 0.34, 1)
_TAPE: Final[Colour] = (0.86, 0.74, 0.55, 1)
_REACH: Final = 0.3
"""Metres from hands that are stretched out to what they can take hold of."""
_GRIP: Final = 30.0


class Kit:
    """A box; a first-aid kit is red, with a cross on it.

    Args:
        at: where it lies.
        first_aid: whether it is one.

    Attributes:
        body: its number in the engine.
        holder: who holds it; None where it lies.
    """

    def __init__(self, engine: Engine, at: Point, *, first_aid: bool) -> None:
        self._engine = engine
        self.body = _built(engine, (*at, _SIZE[2] / 2), first_aid=first_aid)
        self.holder: StickFigure | None = None
        self._grip = -1

    @property
    def place(self) -> Vector:
        """Where its middle is."""
        return self._engine.place_of(self.body)

    def within_reach(self, figure: StickFigure) -> bool:
        """Whether somebody's hands can take hold of it as they are."""
        return dist(figure.hand, self.place) < _REACH

    def take(self, figure: StickFigure) -> None:
        """Fix it between somebody's hands; whoever has held it lets go."""
        self.let_go()
        engine, bullet = self._engine, self._engine.bullet
        hand = PARTS.index("l hand")
        self._grip = engine.call(
            "createConstraint",
            figure.body,
            hand,
            self.body,
            -1,
            bullet.JOINT_POINT2POINT,
            (0, 0, 0),
            (0.02, -0.08, -0.07),
            (0, 0, 0),
        )
        engine.call("changeConstraint", self._grip, maxForce=_GRIP)
        engine.call("setCollisionFilterGroupMask", self.body, -1, 0, 0)
        self.holder, figure.carries = figure, True

    def let_go(self) -> None:
        """Drop it, if anybody holds it."""
        if self.holder is None:
            return
        self._engine.call("removeConstraint", self._grip)
        self._engine.call("setCollisionFilterGroupMask", self.body, -1, 1, 1)
        self.holder.carries = False
        self.holder = None

    def put(self, at: Point) -> None:
        """Lay it somewhere, whoever has held it."""
        self.let_go()
        upright = (0, 0, 0, 1)
        self._engine.call("resetBasePositionAndOrientation", self.body, (*at, _SIZE[2] / 2), upright)


def _built(engine: Engine, at: Vector, *, first_aid: bool) -> int:
    length, width, height = _SIZE
    cross = [(0.05, 0.014, 0.006), (0.014, 0.042, 0.006)] if first_aid else []
    around = (length / 2 + 0.003, 0.018, 0.02)
    trunk = (length / 2, width / 2, height / 2)
    look = engine.look("BOX", _RED if first_aid else _BROWN, halfExtents=trunk)
    lid = (0, 0, height / 2 + 0.004)
    links = [Link(engine.look("BOX", _WHITE, halfExtents=half), lid) for half in cross]
    links.append(Link(engine.look("BOX", _WHITE if first_aid else _TAPE, halfExtents=around)))
    body = engine.body(_MASS, engine.solid("BOX", halfExtents=trunk), look, at, links)
    engine.call("changeDynamics", body, -1, angularDamping=0.9)
    return body
