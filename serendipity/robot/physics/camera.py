"""A camera above the building, and where on its pictures things are."""

from itertools import count
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from serendipity.robot.physics.building import Rooms
from serendipity.robot.physics.engine import Engine, Vector

if TYPE_CHECKING:
    from PIL import Image

_PITCH: Final = -48.0
_ANGLE: Final = 42.0
"""Of view, across and down, of a picture as high as it is wide; in degrees."""
_TALL: Final = 0.45
"""Metres that are to be seen above the floor."""
_MARGIN: Final = 0.02
_LIGHT: Final[dict[str, Any]] = {
    "shadow": 1,
    "lightDirection": (2.0, -3.0, 8.0),
    "lightDistance": 12.0,
    "lightAmbientCoeff": 0.62,
    "lightDiffuseCoeff": 0.5,
    "lightSpecularCoeff": 0.03,
}

Pixel = tuple[float, float]


class Camera:
    """Looks at the whole of a building.

    Args:
        width: of its pictures in pixels; their height follows from the building.

    Attributes:
        width, height: of its pictures.
    """

    def __init__(self, engine: Engine, building: Rooms, width: int) -> None:
        self._engine = engine
        wide, deep = building.width, building.depth
        corners = [(x, y, z) for x in (0.0, wide) for y in (0.0, deep) for z in (0.0, _TALL)]
        bullet = engine.bullet
        self._lens = bullet.computeProjectionMatrixFOV(_ANGLE, 1, 0.1, 60)
        self.width = self.height = width
        self._top = 0
        margin = _MARGIN * width
        for tenths in count(5):
            self._view = bullet.computeViewMatrixFromYawPitchRoll(
                (wide / 2, deep / 2, 0), tenths / 10, 0, _PITCH, 0, 2
            )
            self._matrix = _square(self._lens) @ _square(self._view)
            pixels = [self.pixel(corner) for corner in corners]
            if all(margin <= value <= width - margin for pixel in pixels for value in pixel):
                break
        rows = [y for _, y in pixels]
        self._top = round(min(rows) - margin)
        self.height = round(max(rows) + margin) - self._top

    def pixel(self, point: Vector) -> Pixel:
        """Where on its pictures a point is."""
        x, y, _, w = self._matrix @ np.array([*point, 1.0])
        return float((x / w + 1) / 2 * self.width), float((1 - y / w) / 2 * self.width) - self._top

    def picture(self) -> "Image.Image":
        """What it sees now."""
        from PIL import Image

        side, renderer = self.width, self._engine.bullet.ER_TINY_RENDERER
        pixels = self._engine.call(
            "getCameraImage", side, side, self._view, self._lens, renderer=renderer, **_LIGHT
        )[2]
        array = np.asarray(pixels, dtype=np.uint8).reshape(side, side, 4)
        return Image.fromarray(np.ascontiguousarray(array[self._top : self._top + self.height, :, :3]))


def _square(numbers: tuple[float, ...]) -> NDArray[np.float64]:
    """A matrix as OpenGL writes it, column by column."""
    return np.array(numbers, dtype=np.float64).reshape(4, 4).T
