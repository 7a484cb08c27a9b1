"""Pictures as PNG, painted by matplotlib (the optional extra ``plot``)."""

import io
from typing import TYPE_CHECKING, Any

from serendipity.model import UsageError
from serendipity.model.printable import printable
from serendipity.pictures.picture.drawing import (
    Circle,
    Picture,
    Polyline,
    Rect,
    Shape,
    ShapeGroup,
    Style,
    Text,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DPI = 72  # one unit of a picture is a point, so font sizes need no conversion
_MOST_PIXELS = 10_000


def png(picture: Picture) -> bytes:
    """A picture as PNG: two pixels a unit, or less where it would have more than 10,000 a side.

    Raises:
        UsageError: matplotlib is not installed.
    """
    scale = min(2.0, _MOST_PIXELS / max(picture.width, picture.height))
    size = (picture.width / _DPI, picture.height / _DPI)
    figure = empty_figure("PNG pictures", figsize=size, dpi=_DPI * scale)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0, picture.width)
    axes.set_ylim(picture.height, 0)
    axes.set_axis_off()
    painter = _Painter(axes)
    for shape in picture.shapes:
        painter.paint(shape, 0, 0)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", metadata={"Software": None})
    return buffer.getvalue()


def empty_figure(what: str, **look: Any) -> "Figure":
    """A figure of matplotlib without anything on it.

    Raises:
        UsageError: it is not installed; ``what`` need it.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise UsageError(f"{what} need matplotlib: pip install serendipity-planner[plot]") from None
    empty = Figure(**look)
    FigureCanvasAgg(empty)
    return empty


class _Painter:
    """Adds shapes to axes, each above the ones before."""

    def __init__(self, axes: "Axes") -> None:
        self.axes = axes
        self.order = 1.0

    def paint(self, shape: Shape, x: float, y: float) -> None:
        from matplotlib import patches

        self.order += 1
        match shape:
            case ShapeGroup():
                for inner in shape.shapes:
                    self.paint(inner, x + shape.x, y + shape.y)
            case Rect():
                # The style's rounding is a padding: the box inside is smaller by it.
                r = min(shape.round, shape.width / 2, shape.height / 2)
                corner = (x + shape.x + r, y + shape.y + r)
                size = (shape.width - 2 * r, shape.height - 2 * r)
                box = f"round,pad={r},rounding_size={r}" if r else "square,pad=0"
                patch = patches.FancyBboxPatch(corner, *size, boxstyle=box, **self._look(shape.style))
                self.axes.add_patch(patch)
            case Circle():
                centre = (x + shape.x, y + shape.y)
                self.axes.add_patch(patches.Circle(centre, shape.radius, **self._look(shape.style)))
            case Polyline() if shape.points:
                points = [(x + px, y + py) for px, py in shape.points]
                look = self._look(shape.style) | {"capstyle": "round", "joinstyle": "round"}
                self.axes.add_patch(patches.Polygon(points, closed=shape.closed, **look))
            case Text():
                self._write(shape, x, y)

    def _look(self, style: Style) -> dict[str, Any]:
        dash = "solid" if not style.dash else (0, tuple(d / style.width for d in style.dash))
        return {
            "facecolor": style.fill or "none",
            "edgecolor": style.stroke or "none",
            "linewidth": style.width if style.stroke else 0,
            "linestyle": dash,
            "alpha": style.opacity,
            "zorder": self.order,
        }

    def _write(self, text: Text, x: float, y: float) -> None:
        self.axes.text(
            x + text.x,
            y + text.y,
            printable(text.text).replace("$", r"\$"),
            fontsize=text.size * 0.88,  # its font is wider than the usual ones of browsers
            color=text.colour,
            ha={"middle": "center", "start": "left", "end": "right"}[text.anchor],
            va="center_baseline",
            weight="bold" if text.bold else "normal",
            zorder=self.order,
        )
