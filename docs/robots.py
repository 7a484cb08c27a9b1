"""Films the figures of docs/robot.md again (``make pictures``; needs the extra ``robot``).

The paper's III-C and III-D, as clips and as strips of some epochs, and III-C with rubble in a doorway.
"""

import io
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from PIL import Image

import serendipity
from serendipity.model import Task, UsageError
from serendipity.robot.physics import Film, Stage

IMAGES = Path(__file__).parent / "images"
RATE = 3.0
"""Frames for each second."""


class Scene(NamedTuple):
    """A run to film.

    Attributes:
        example: its task.
        human: who the person is.
        mode: of the robots' plan.
        rubble: kilograms of it in doorways.
        epochs: that the strip shows.
        clip: whether it becomes a clip, too.
    """

    example: str
    human: str
    mode: str
    rubble: Mapping[tuple[str, str], float]
    epochs: tuple[int, ...]
    clip: bool


HEAP = {("room4", "room3"): 11.0}
SCENES = {
    "robot-iii-c": Scene("room2", "observant", "serendipity", {}, (2, 3, 6, 11), clip=True),
    "robot-iii-d": Scene("room7", "omniscient", "communication", {}, (2, 3, 6), clip=True),
    "robot-rubble": Scene("room2", "observant", "serendipity", HEAP, (2, 3, 6), clip=False),
}


def main() -> int:
    """Film all scenes."""
    for name in sys.argv[1:] or SCENES:
        scene = SCENES[name]
        try:
            film, log = filmed(scene)
        except UsageError as error:
            sys.stderr.write(f"Error: {error}\n")
            return 2
        pictures = {".png": strip(film, log, scene.epochs)}
        if scene.clip:
            pictures[".gif"] = film.clip(".gif", log)
        for suffix, picture in pictures.items():
            (IMAGES / name).with_suffix(suffix).write_bytes(picture)
            sys.stdout.write(f"docs/images/{name}{suffix}\n")
    return 0


def filmed(scene: Scene) -> tuple[Film, tuple[dict[str, object], ...]]:
    """A scene's film, and its log."""
    film = Film(rate=RATE)

    def stage(task: Task, _dice: object) -> Stage:
        return Stage(task, rubble=scene.rubble, film=film)

    task = serendipity.example(scene.example)
    epochs = None if scene.clip else max(scene.epochs)
    runs = serendipity.execute(
        task, scene.human, discount="0.6", mode=scene.mode, adapter=stage, epochs=epochs
    )
    for line in runs.story():
        sys.stdout.write(f"  {line}\n")
    return film, runs.logs[0]


def strip(film: Film, log: tuple[dict[str, object], ...], epochs: tuple[int, ...]) -> bytes:
    """Moments in the middle of some epochs as one picture, below each other, as PNG."""
    pages = film.pages(log)
    of = {epoch: [page for at, page in pages if at == epoch] for epoch in epochs}
    shown = [frames[len(frames) // 2] for frames in of.values()]
    picture = Image.new("RGB", (shown[0].width, (shown[0].height + 6) * len(shown) - 6), (96, 100, 110))
    for number, page in enumerate(shown):
        picture.paste(page, (0, number * (page.height + 6)))
    buffer = io.BytesIO()
    picture.quantize(96, dither=Image.Dither.NONE).save(buffer, "png", optimize=True)
    return buffer.getvalue()


if __name__ == "__main__":
    sys.exit(main())
