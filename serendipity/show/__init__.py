"""Plans as pictures: a page that plays them, and stills.

``build_scene`` computes everything that is shown from a task and a result; ``draw`` only
draws it.
"""

from serendipity.model import UsageError
from serendipity.show.scene.building import build_scene
from serendipity.show.scene.scene import Scene

__all__ = ["Scene", "build_scene", "draw"]


def draw(scene: Scene, suffix: str, epoch: int | None = None) -> str | bytes:
    """A scene as the content of a file.

    Args:
        scene: what to draw.
        suffix: ``.html`` for a page; ``.svg`` or ``.png`` for a still.
        epoch: of a still; None for the one that says most.

    Raises:
        UsageError: there is no such epoch or form, or PNG lacks the extra ``plot``.
    """
    last = scene.frames[-1].epoch
    if epoch is not None and not 0 <= epoch <= last:
        raise UsageError(f"epoch: expected one from 0 to {last}, got {epoch}")
    if suffix == ".html":
        from serendipity.show.formats.page import page

        return page(scene)
    from serendipity.show.picture.still import still

    picture = still(scene, epoch)
    if suffix == ".svg":
        from serendipity.show.formats.svg import svg

        return svg(picture) + "\n"
    if suffix == ".png":
        from serendipity.show.formats.png import png

        return png(picture)
    raise UsageError(f"expected a picture .html, .svg or .png, got '{suffix}'")
