"""The physics engine: Bullet, loaded where it is first used (the optional extra ``robot``)."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Final, NamedTuple

from serendipity.model import UsageError

RATE: Final = 120
"""Steps of the simulation in a second."""

Vector = tuple[float, float, float]
Colour = tuple[float, float, float, float]

_SOLVER_PASSES: Final = 60


class Link(NamedTuple):
    """A part of a body, which hangs on another part by a joint.

    Attributes:
        look: its form to be seen.
        at: where its joint is, from that of the part it hangs on.
        axis: about which it turns; None: it is fixed.
        mass: in kilograms.
        middle: of its mass, from its joint.
        parent: number of the part that it hangs on, the trunk being 0.
        solid: its form that others meet; -1 for none.
    """

    look: int
    at: Vector = (0, 0, 0)
    axis: Vector | None = None
    mass: float = 0.001
    middle: Vector = (0, 0, 0)
    parent: int = 0
    solid: int = -1


class Engine:
    """A world of its own, without a window.

    Attributes:
        bullet: the module ``pybullet``.
        seconds: that have passed in it.

    Raises:
        UsageError: pybullet is not installed.
    """

    def __init__(self) -> None:
        if find_spec("pybullet") is None:
            raise UsageError("robots in physics need pybullet: pip install serendipity-planner[robot]")
        with _silenced():
            self.bullet: Any = import_module("pybullet")
        self._client = self.bullet.connect(self.bullet.DIRECT)
        self.seconds = 0.0
        self.call("setGravity", 0, 0, -9.81)
        self.call("setTimeStep", 1 / RATE)
        self.call(
            "setPhysicsEngineParameter", numSolverIterations=_SOLVER_PASSES, deterministicOverlappingPairs=1
        )

    def call(self, name: str, *arguments: Any, **named: Any) -> Any:
        """A function of pybullet's in this world."""
        return getattr(self.bullet, name)(*arguments, **named, physicsClientId=self._client)

    def step(self) -> None:
        """Let a moment pass."""
        self.call("stepSimulation")
        self.seconds += 1 / RATE

    def close(self) -> None:
        """The end of this world."""
        if self._client >= 0:
            self.call("disconnect")
            self._client = -1

    def look(self, form: str, colour: Colour, at: Vector = (0, 0, 0), **size: Any) -> int:
        """A form to be seen (``BOX``, ``SPHERE`` ...), about a point of the part that has it."""
        kind = getattr(self.bullet, f"GEOM_{form}")
        return int(self.call("createVisualShape", kind, rgbaColor=colour, visualFramePosition=at, **size))

    def solid(self, form: str, at: Vector = (0, 0, 0), **size: Any) -> int:
        """A form that others meet, likewise."""
        kind = getattr(self.bullet, f"GEOM_{form}")
        return int(self.call("createCollisionShape", kind, collisionFramePosition=at, **size))

    def body(self, mass: float, solid: int, look: int, at: Vector, links: Sequence[Link] = ()) -> int:
        """A body: its trunk, and what hangs on it; without mass the trunk stays where it is."""
        turning, fixed, count = self.bullet.JOINT_REVOLUTE, self.bullet.JOINT_FIXED, len(links)
        upright = [(0, 0, 0, 1)] * count
        made = self.call(
            "createMultiBody",
            *(mass, solid, look, at),
            linkMasses=[link.mass for link in links],
            linkCollisionShapeIndices=[link.solid for link in links],
            linkVisualShapeIndices=[link.look for link in links],
            linkPositions=[link.at for link in links],
            linkOrientations=upright,
            linkInertialFramePositions=[link.middle for link in links],
            linkInertialFrameOrientations=upright,
            linkParentIndices=[link.parent for link in links],
            linkJointTypes=[fixed if link.axis is None else turning for link in links],
            linkJointAxis=[link.axis or (0, 0, 1) for link in links],
        )
        return int(made)

    def box(
        self, size: Vector, centre: Vector, colour: Colour, mass: float = 0.0, *, solid: bool = True
    ) -> int:
        """A box, by its whole sides; without mass it stays where it is."""
        half = [side / 2 for side in size]
        shape = self.solid("BOX", halfExtents=half) if solid else -1
        return self.body(mass, shape, self.look("BOX", colour, halfExtents=half), centre)

    def place_of(self, body: int) -> Vector:
        """Where the middle of a body is."""
        position: Sequence[float] = self.call("getBasePositionAndOrientation", body)[0]
        return position[0], position[1], position[2]


@contextmanager
def _silenced() -> Iterator[None]:
    """Without what is printed past Python: pybullet says when it was built."""
    kept = [os.dup(1), os.dup(2)]
    with open(os.devnull, "wb") as nowhere:  # noqa: PTH123 - a descriptor is all that is wanted
        try:
            for stream in (1, 2):
                os.dup2(nowhere.fileno(), stream)
            yield
        finally:
            for stream, copy in enumerate(kept, start=1):
                os.dup2(copy, stream)
                os.close(copy)
