"""Bodies: stick figures that are led while motors move their limbs, and things that they take and hand over.

Figures are of the size of a Nao.  They have the shapes of no particular robot.
"""

from math import atan2, cos, dist, hypot, pi, sin
from typing import Final, NamedTuple

from serendipity.robot.physics.building import Point
from serendipity.robot.physics.engine import RATE, Colour, Engine, Link, Vector

THIGH: Final = 0.14
SHIN: Final = 0.15
_TRUNK: Final = 0.17
_ARM: Final = 0.11
_HIP: Final = 0.05
_SHOULDER: Final = 0.085
_HEAD: Final = 0.062
_LIMB: Final = 0.02
RADIUS: Final = 0.11
"""Of the room that a figure takes, in metres."""
_HEIGHT: Final = THIGH + SHIN + 0.02
"""Of the hips above the floor."""

_MASS: Final = 4.0
_LIMB_MASS: Final = 0.1
_PULL: Final = 60.0
"""The most force that leads the trunk, in newtons: what weighs more than that stays where it is."""
_TORQUE: Final = 4.0
_STRIDE: Final = 0.2  # metres of a whole step, left and right
_LEASH: Final = 0.08  # how far ahead of the trunk the point may be that leads it, in metres
_TURN: Final = 5.0  # radians in a second
_CLOSE: Final = 0.02  # metres

PARTS: Final = ("head", *(f"{side} {part}" for side in "lr" for part in ("arm", "hand", "thigh", "shin")))
"""The links, in the order of their numbers."""


class Pose(NamedTuple):
    """Angles of joints in radians, forwards; how low the hips are, in metres."""

    arms: tuple[float, float] = (0.0, 0.0)
    elbows: tuple[float, float] = (-0.3, -0.3)
    hips: tuple[float, float] = (0.0, 0.0)
    knees: tuple[float, float] = (0.0, 0.0)
    low: float = 0.0


STAND: Final = Pose()
REACH: Final = Pose(arms=(-1.2, -1.2), elbows=(-0.2, -0.2))
KNEEL: Final = Pose(arms=(-0.9, -0.9), elbows=(-0.1, -0.1), hips=(-1.5, -1.5), knees=(2.2, 2.2), low=0.15)
CARRY: Final = (-0.75, -0.75), (-0.9, -0.9)
"""Arms and elbows of who carries something."""


class StickFigure:
    """A body that walks.

    Args:
        at: where it stands.
        colour: of trunk and limbs.
        cap: of its head.
        size: 1 is the size of a Nao.

    Attributes:
        body: its number in the engine.
        walked: metres so far.
    """

    def __init__(self, engine: Engine, at: Point, colour: Colour, cap: Colour, size: float = 1.0) -> None:
        self._engine = engine
        self._size = size
        self.body = _built(engine, at, colour, cap, size)
        bullet = engine.bullet
        for link in range(len(PARTS)):
            engine.call("setJointMotorControl2", self.body, link, bullet.VELOCITY_CONTROL, force=0)
        self._lead = at
        self._heading = -pi / 2
        self._pose = STAND
        self.walked = 0.0
        self.carries = False
        self._last = at
        self._leash = engine.call(
            "createConstraint",
            self.body,
            -1,
            -1,
            -1,
            bullet.JOINT_FIXED,
            (0, 0, 0),
            (0, 0, 0),
            (*at, self._hips),
        )

    @property
    def at(self) -> Point:
        """Where it is on the floor."""
        x, y, _ = self._engine.place_of(self.body)
        return x, y

    @property
    def hand(self) -> Vector:
        """Where it holds things: between its hands."""
        ends = [self._tip(PARTS.index(f"{side} hand")) for side in "lr"]
        x, y, z = ((a + b) / 2 for a, b in zip(*ends, strict=True))
        return x, y, z

    @property
    def top(self) -> Vector:
        """Above its head."""
        x, y, z = self._engine.place_of(self.body)
        return x, y, z + self._size * (_TRUNK + 2.6 * _HEAD)

    @property
    def _hips(self) -> float:
        return self._size * _HEIGHT

    def away(self, target: Point) -> float:
        """Metres to a point on the floor."""
        x, y = self.at
        return hypot(target[0] - x, target[1] - y)

    def walk(self, target: Point, speed: float) -> bool:
        """Lead it towards a point for a moment; whether it is there.

        Args:
            speed: in metres a second.
        """
        left = self.away(target)
        if left < _CLOSE:
            self.rest()
            return True
        x, y = self.at
        ahead = min(left, _LEASH, speed / RATE + hypot(self._lead[0] - x, self._lead[1] - y))
        self._lead = x + (target[0] - x) / left * ahead, y + (target[1] - y) / left * ahead
        self._face(atan2(target[1] - y, target[0] - x))
        self._stride()
        return False

    def rest(self, pose: Pose = STAND, facing: Point | None = None) -> None:
        """Stay where it is for a moment, in a pose."""
        if facing is not None:
            x, y = self.at
            self._face(atan2(facing[1] - y, facing[0] - x))
        self._take(pose)

    def _stride(self) -> None:
        """The pose of a walk: legs swing with the way that is really gone."""
        x, y = self.at
        self.walked += hypot(x - self._last[0], y - self._last[1])
        self._last = x, y
        phase = 2 * pi * self.walked / (_STRIDE * self._size)
        swing = 0.55 * sin(phase)
        bent = [0.15 + 0.7 * max(0.0, cos(phase + turn)) for turn in (0.0, pi)]
        self._take(
            Pose(
                arms=(0.5 * sin(phase), -0.5 * sin(phase)),
                hips=(-swing - 0.5 * bent[0] + 0.1, swing - 0.5 * bent[1] + 0.1),
                knees=(bent[0], bent[1]),
                low=0.008 * (1 + sin(2 * phase)),
            )
        )

    def _face(self, heading: float) -> None:
        turn = (heading - self._heading + pi) % (2 * pi) - pi
        most = _TURN / RATE
        self._heading += max(-most, min(most, turn))

    def _take(self, pose: Pose) -> None:
        low = self._pose.low + max(-0.4 / RATE, min(0.4 / RATE, pose.low - self._pose.low))
        if self.carries and pose.low < 0.1 and pose is not REACH:
            pose = pose._replace(arms=CARRY[0], elbows=CARRY[1])
        self._pose = pose._replace(low=low)
        engine = self._engine
        height = self._hips - low * self._size
        turned = engine.call("getQuaternionFromEuler", (0, 0, self._heading))
        engine.call("changeConstraint", self._leash, (*self._lead, height), turned, maxForce=_PULL)
        angles = {"arm": pose.arms, "hand": pose.elbows, "thigh": pose.hips, "shin": pose.knees}
        for side, letter in enumerate("lr"):
            for part, both in angles.items():
                engine.call(
                    "setJointMotorControl2",
                    self.body,
                    PARTS.index(f"{letter} {part}"),
                    engine.bullet.POSITION_CONTROL,
                    targetPosition=both[side],
                    force=_TORQUE,
                    maxVelocity=8.0,
                )

    def _tip(self, link: int) -> Vector:
        """The far end of a limb."""
        state = self._engine.call("getLinkState", self.body, link, computeForwardKinematics=1)
        tip, _ = self._engine.call(
            "multiplyTransforms", state[4], state[5], (0, 0, -_ARM * self._size), (0, 0, 0, 1)
        )
        return tip[0], tip[1], tip[2]


def _built(engine: Engine, at: Point, colour: Colour, cap: Colour, size: float) -> int:
    dark: Colour = (colour[0] * 0.7, colour[1] * 0.7, colour[2] * 0.7, 1)

    def scaled(x: float, y: float, z: float) -> Vector:
        return x * size, y * size, z * size

    def limb(parent: int, joint: Vector, length: float, colour: Colour) -> Link:
        middle = scaled(0, 0, -length / 2)
        look = engine.look("CAPSULE", colour, middle, radius=_LIMB * size, length=length * size)
        return Link(look, scaled(*joint), (0, 1, 0), _LIMB_MASS, middle, parent)

    head = engine.look("SPHERE", cap, radius=_HEAD * size)
    links = [Link(head, scaled(0, 0, _TRUNK + _HEAD * 1.1), mass=_LIMB_MASS)]
    for side in (1, -1):
        arm = len(links) + 1
        links.append(limb(0, (0, side * _SHOULDER, _TRUNK - 0.01), _ARM, colour))
        links.append(limb(arm, (0, 0, -_ARM), _ARM, dark))
        links.append(limb(0, (0, side * _HIP, -0.01), THIGH, colour))
        links.append(limb(arm + 2, (0, 0, -THIGH), SHIN, dark))
    low, high = -_HEIGHT + 0.03, _TRUNK
    around = scaled(0, 0, (low + high) / 2)
    solid = engine.solid("CYLINDER", around, radius=RADIUS, height=(high - low) * size)
    trunk = [0.045 * size, 0.07 * size, _TRUNK / 2 * size]
    look = engine.look("BOX", colour, scaled(0, 0, _TRUNK / 2), halfExtents=trunk)
    return engine.body(_MASS, solid, look, (*at, _HEIGHT * size), links)


_SIZE: Final[Vector] = (0.15, 0.11, 0.09)
_KIT_MASS: Final = 0.2
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
        self.body = _kit_body(engine, (*at, _SIZE[2] / 2), first_aid=first_aid)
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


def _kit_body(engine: Engine, at: Vector, *, first_aid: bool) -> int:
    length, width, height = _SIZE
    cross = [(0.05, 0.014, 0.006), (0.014, 0.042, 0.006)] if first_aid else []
    around = (length / 2 + 0.003, 0.018, 0.02)
    trunk = (length / 2, width / 2, height / 2)
    look = engine.look("BOX", _RED if first_aid else _BROWN, halfExtents=trunk)
    lid = (0, 0, height / 2 + 0.004)
    links = [Link(engine.look("BOX", _WHITE, halfExtents=half), lid) for half in cross]
    links.append(Link(engine.look("BOX", _WHITE if first_aid else _TAPE, halfExtents=around)))
    body = engine.body(_KIT_MASS, engine.solid("BOX", halfExtents=trunk), look, at, links)
    engine.call("changeDynamics", body, -1, angularDamping=0.9)
    return body
