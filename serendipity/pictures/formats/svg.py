"""Pictures as SVG, written by hand: no library is needed."""

from collections.abc import Iterator, Mapping

from serendipity.model.printable import markup
from serendipity.pictures.picture import drawing

_FONT = "system-ui, 'DejaVu Sans', 'Segoe UI', Arial, sans-serif"


def svg(picture: drawing.Picture, *, inline: bool = False, **attributes: str) -> str:
    """A picture as an SVG element.

    Args:
        inline: for a page, which sets the size; else a file of its own, on white.
    """
    width, height = number(picture.width), number(picture.height)
    own: dict[str, str | float] = {
        "xmlns": "http://www.w3.org/2000/svg",
        "viewBox": f"0 0 {width} {height}",
        "width": width,
        "height": height,
        "role": "img",
        "aria-label": picture.description,
        "font-family": _FONT,
        **attributes,
    }
    body = "".join(part for shape in picture.shapes for part in _shape(shape))
    paper = "" if inline else '<rect width="100%" height="100%" fill="#ffffff"/>'
    title = f"<title>{markup(picture.description)}</title>" if not inline else ""
    return f"<svg{_attributes(own)}>{title}{paper}{body}</svg>"


def number(value: float) -> str:
    """A coordinate, as short as it can be."""
    return f"{value:.2f}".rstrip("0").rstrip(".")


def path(points: tuple[drawing.Point, ...], *, closed: bool = False) -> str:
    """The ``d`` of a line through points."""
    joined = "L".join(f"{number(x)} {number(y)}" for x, y in points)
    return (f"M{joined}" + ("Z" if closed else "")) if points else ""


def _shape(shape: drawing.Shape) -> Iterator[str]:
    match shape:
        case drawing.Rect():
            place = {"x": shape.x, "y": shape.y, "width": shape.width, "height": shape.height}
            corner = {"rx": shape.round} if shape.round else {}
            yield f"<rect{_attributes({**place, **corner, **_paint(shape.style)})}/>"
        case drawing.Circle():
            place = {"cx": shape.x, "cy": shape.y, "r": shape.radius}
            yield f"<circle{_attributes({**place, **_paint(shape.style)})}/>"
        case drawing.Polyline():
            drawn = {"d": path(shape.points, closed=shape.closed), **_paint(shape.style)}
            joins = {"stroke-linejoin": "round", "stroke-linecap": "round"}
            yield f"<path{_attributes({**drawn, **joins, **_data(shape.data)})}/>"
        case drawing.Text():
            yield _text(shape)
        case drawing.ShapeGroup():
            placed = {"transform": f"translate({number(shape.x)} {number(shape.y)})"}
            moved = placed if shape.x or shape.y or shape.data else {}
            yield f"<g{_attributes({**moved, **_data(shape.data)})}>"
            if shape.title:
                yield f"<title>{markup(shape.title)}</title>"
            for inner in shape.shapes:
                yield from _shape(inner)
            yield "</g>"


def _text(text: drawing.Text) -> str:
    attributes: dict[str, str | float] = {
        "x": text.x,
        "y": text.y,
        "font-size": text.size,
        "fill": text.colour,
        "text-anchor": text.anchor,
        "dy": ".35em",
        **({"font-weight": "700"} if text.bold else {}),
    }
    return f"<text{_attributes(attributes)}>{markup(text.text)}</text>"


def _paint(style: drawing.Style) -> dict[str, str]:
    paint = {"fill": style.fill or "none"}
    if style.stroke is not None:
        paint |= {"stroke": style.stroke, "stroke-width": number(style.width)}
        if style.dash:
            paint["stroke-dasharray"] = " ".join(map(number, style.dash))
    if style.opacity < 1:
        paint["opacity"] = number(style.opacity)
    return paint


def _data(data: Mapping[str, str]) -> dict[str, str]:
    return {f"data-{key}": value for key, value in data.items()}


def _attributes(values: Mapping[str, str | float]) -> str:
    written = {key: value if isinstance(value, str) else number(value) for key, value in values.items()}
    return "".join(f' {key}="{markup(value)}"' for key, value in written.items())
