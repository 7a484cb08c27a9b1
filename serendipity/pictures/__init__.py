"""Plans as pictures: a page that plays them, and stills.

``build_scene`` computes everything that is shown from a task and a result; ``draw`` only
draws it.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from numbers import Integral

from serendipity.model import UsageError
from serendipity.pictures.formats.page import page
from serendipity.pictures.formats.png import png
from serendipity.pictures.formats.svg import svg
from serendipity.pictures.picture.drawing import Picture
from serendipity.pictures.picture.front import front_picture
from serendipity.pictures.picture.heat_map import Savings, heat_map
from serendipity.pictures.picture.timeline_picture import still
from serendipity.pictures.scene.building import build_scene, other_scenes
from serendipity.pictures.scene.scene import Scene

__all__ = ["Scene", "build_scene", "check_epoch", "draw", "draw_front", "draw_windows", "other_scenes"]


def draw(
    scene: Scene, suffix: str, epoch: int | None = None, others: Callable[[], Iterable[Scene]] = tuple
) -> str | bytes:
    """A scene as the content of a file.

    Args:
        suffix: ``.html`` for a page; ``.svg`` or ``.png`` for a still.
        epoch: of a still; None for the one that says most.
        others: makes what can be chosen on a page instead.

    Raises:
        UsageError: there is no such epoch or form, or PNG lacks the extra ``plot``.
    """
    check_epoch(scene, epoch)
    if suffix == ".html":
        return page(scene, others())
    return _written(still(scene, epoch), suffix, ".html, .svg or .png")


def check_epoch(scene: Scene, epoch: int | None) -> None:
    """Whether there is such an epoch."""
    last = scene.frames[-1].epoch
    if epoch is not None and not (isinstance(epoch, Integral) and 0 <= epoch <= last):
        raise UsageError(f"epoch: expected one from 0 to {last}, got {epoch!r:.50}")


def draw_windows(maps: Mapping[str, Savings], starts: int, horizon: int, suffix: str) -> str | bytes:
    """Heat maps over windows, ``.svg`` or ``.png``; see :func:`.picture.heat_map.heat_map`."""
    return _written(heat_map(maps, starts, horizon), suffix, ".svg or .png")


def draw_front(points: Sequence[tuple[Fraction, Fraction]], suffix: str) -> str | bytes:
    """A front of disturbance and saving, ``.svg`` or ``.png``; see :func:`.picture.front.front_picture`."""
    return _written(front_picture(points), suffix, ".svg or .png")


def _written(picture: Picture, suffix: str, known: str) -> str | bytes:
    if suffix == ".svg":
        return svg(picture) + "\n"
    if suffix == ".png":
        return png(picture)
    raise UsageError(f"expected a picture {known}, got '{suffix}'")
