"""The physics engine: Bullet, loaded where it is first used (the optional extra ``robot``)."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Final

from serendipity.model import UsageError

RATE: Final = 120
"""Steps of the simulation in a second."""

Vector = tuple[float, float, float]
Colour = tuple[float, float, float, float]

_SOLVER_PASSES: Final = 60


class Engine:
    """A world of its own, without a window.

    Attributes:
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
        passes = {"numSolverIterations": _SOLVER_PASSES, "deterministicOverlappingPairs": 1}
        self.call("setPhysicsEngineParameter", **passes)

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

    def look(self, form: str, colour: Colour, **size: Any) -> int:
        """A form to be seen (``BOX``, ``SPHERE`` ...)."""
        kind = getattr(self.bullet, f"GEOM_{form}")
        return int(self.call("createVisualShape", kind, rgbaColor=colour, **size))

    def solid(self, form: str, **size: Any) -> int:
        """A form that others meet, likewise."""
        return int(self.call("createCollisionShape", getattr(self.bullet, f"GEOM_{form}"), **size))

    def body(
        self, mass: float, solid: int, look: int, at: Vector, parts: Sequence[tuple[int, Vector]] = ()
    ) -> int:
        """A body, and looks that are fixed to it, each in its place; without mass it stays where it is."""
        count = len(parts)
        made = self.call(
            "createMultiBody",
            *(mass, solid, look, at),
            linkMasses=[0.001] * count,
            linkCollisionShapeIndices=[-1] * count,
            linkVisualShapeIndices=[seen for seen, _ in parts],
            linkPositions=[place for _, place in parts],
            linkOrientations=[(0, 0, 0, 1)] * count,
            linkInertialFramePositions=[(0, 0, 0)] * count,
            linkInertialFrameOrientations=[(0, 0, 0, 1)] * count,
            linkParentIndices=[0] * count,
            linkJointTypes=[self.bullet.JOINT_FIXED] * count,
            linkJointAxis=[(0, 0, 1)] * count,
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
