"""Films of a stage: a camera with the engine's own renderer, words by Pillow."""

import io
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from serendipity.model import UsageError
from serendipity.model.numbers import plain
from serendipity.robot.physics.building import Rooms
from serendipity.robot.physics.engine import Engine, Vector
from serendipity.robot.physics.figure import Kit, Walker

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
    """Looks at the whole of a building; pictures are ``width`` pixels wide, and as high as that takes."""

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


FORMATS: Final = (".gif", ".png", ".webp")
"""Of clips, by suffix; ``.png`` is an animated one."""

_RATE: Final = 4.0  # frames for each second of the stage
_SHOWN: Final = 90  # milliseconds of a frame in a clip
_LAST: Final = 2500  # of the last one
_COLOURS: Final = 96
_INSET: Final = 0.05, 0.16  # of the names of places, from their corners; in metres
_HEAD: Final = 62  # pixels above the picture, for words
_INK: Final = (35, 38, 45)
_PALE: Final = (96, 100, 110)
_RED: Final = (190, 25, 25)
_PAPER: Final = (255, 255, 255)


class _Frame(NamedTuple):
    """A moment: its epoch, what was to be seen, and where whose name belongs."""

    epoch: int
    image: "Image.Image"
    agents: dict[str, Pixel]
    things: dict[str, Pixel]


class Film:
    """Records a stage: pictures of a width in pixels, so many for each of its seconds.

    Raises:
        UsageError: Pillow is not installed.
    """

    def __init__(self, width: int = 960, rate: float = _RATE) -> None:
        if find_spec("PIL") is None:
            raise UsageError("clips need Pillow: pip install serendipity-planner[robot]")
        self._width = width
        self._rate = rate
        self._frames: list[_Frame] = []

    def begin(
        self, engine: Engine, building: Rooms, figures: Mapping[str, Walker], things: Mapping[str, Kit]
    ) -> None:
        """Set up the camera before what is to be seen."""
        self._engine = engine
        self._camera = Camera(engine, building, self._width)
        self._figures, self._things = figures, things
        self._next = 0.0
        corners = building.corners.items()
        self._places = {
            place: self._camera.pixel((x + _INSET[0], y + _INSET[1], 0.0)) for place, (x, y) in corners
        }

    def watch(self, epoch: int) -> None:
        """Take a picture, if it is time for one."""
        if self._engine.seconds < self._next:
            return
        self._next = self._engine.seconds + 1 / self._rate
        agents = {name: self._camera.pixel(figure.top) for name, figure in self._figures.items()}
        things = {name: self._camera.pixel(thing.place) for name, thing in self._things.items()}
        self._frames.append(_Frame(epoch, self._camera.picture(), agents, things))

    def clip(self, suffix: str, log: Sequence[Mapping[str, Any]]) -> bytes:
        """All frames as a moving picture.

        Args:
            suffix: one of ``FORMATS``.
            log: of the run: what stands above the pictures.

        Raises:
            UsageError: nothing was recorded.
        """
        from PIL import Image

        pages = [page for _, page in self.pages(log)]
        times = [_SHOWN] * (len(pages) - 1) + [_LAST]
        first, rest = pages[0], pages[1:]
        form = suffix.lower().removeprefix(".")
        if form != "webp":
            first = first.quantize(_COLOURS, dither=Image.Dither.NONE)
            rest = [page.quantize(palette=first, dither=Image.Dither.NONE) for page in rest]
        buffer = io.BytesIO()
        first.save(
            buffer, form, save_all=True, append_images=rest, duration=times, loop=0, optimize=True, quality=60
        )
        return buffer.getvalue()

    def pages(self, log: Sequence[Mapping[str, Any]]) -> "list[tuple[int, Image.Image]]":
        """All frames with the words above them, each with its epoch."""
        if not self._frames:
            raise UsageError("clip: nothing was recorded")
        return [(frame.epoch, self._page(frame, log)) for frame in self._frames]

    def _page(self, frame: _Frame, log: Sequence[Mapping[str, Any]]) -> "Image.Image":
        from PIL import Image, ImageDraw, ImageFont

        page = Image.new("RGB", (self._width, self._camera.height + _HEAD), _PAPER)
        page.paste(frame.image, (0, _HEAD))
        draw = ImageDraw.Draw(page)
        fonts = {size: ImageFont.load_default(size) for size in (12, 14, 16, 20)}
        event = next((line for line in log if line.get("epoch") == frame.epoch), None)
        if event is not None:
            draw.text((14, 9), f"epoch {frame.epoch}", _INK, fonts[20])
            did = " · ".join(_deeds(event))
            draw.text((126, 12), did, _INK, fonts[16])
            draw.text((126, 36), f"robots: {event['decision']['reason']}", _PALE, fonts[14])
            costs = f"{log[0]['human']} {plain(event['human_cost'])} · team {plain(event['cost'])}"
            draw.text((self._width - 14, 11), costs, _INK, fonts[16], anchor="ra")
            draw.text((self._width - 14, 36), "paid so far", _PALE, fonts[14], anchor="ra")
        for name, (x, y) in self._places.items():
            draw.text((x, y + _HEAD), name, _PALE, fonts[12], anchor="ls")
        outlined: dict[str, Any] = {"font": fonts[14], "stroke_width": 2, "stroke_fill": _PAPER}
        for name, (x, y) in frame.things.items():
            draw.text((x + 9, y + _HEAD + 17), name, _RED, anchor="ls", **outlined)
        for name, (x, y) in frame.agents.items():
            draw.text((x, y + _HEAD - 3), name, _INK, anchor="ms", **outlined)
        return page


def check_format(path: Path) -> None:
    """A UsageError for what no clip can be written as."""
    if path.suffix.lower() not in FORMATS:
        raise UsageError(f"clip: expected a name that ends in one of {', '.join(FORMATS)}, got '{path.name}'")


def _deeds(event: Mapping[str, Any]) -> list[str]:
    """What takes place in an epoch, and what does not."""
    told = [(step, "") for step in event["steps"]]
    told += [(one, f" ({one['why']})") for one in event["unfinished"]]
    return [f"{' and '.join(step['agents'])}: {_short(step)}{why}" for step, why in told]


def _short(step: Mapping[str, Any]) -> str:
    """An action without those who take part."""
    words = [word for word in step["action"].split() if word not in step["agents"]]
    return " ".join(words).replace("_", " ")
