"""What a map shows where, read from its SVG."""

import xml.etree.ElementTree as ET
from dataclasses import dataclass

from serendipity.pictures import Scene
from serendipity.pictures.formats.svg import svg
from serendipity.pictures.picture.map_picture import map_picture

SVG = "{http://www.w3.org/2000/svg}"


@dataclass(frozen=True)
class Drawn:
    """A token: its rectangle and words."""

    left: float
    top: float
    right: float
    bottom: float
    text: str
    title: str

    def overlaps(self, other: "Drawn") -> bool:
        across = min(self.right, other.right) - max(self.left, other.left)
        along = min(self.bottom, other.bottom) - max(self.top, other.top)
        return across > 0.1 and along > 0.1

    def encloses(self, other: "Drawn") -> bool:
        return (
            self.left <= other.left
            and self.top <= other.top
            and other.right <= self.right
            and other.bottom <= self.bottom
        )


def drawn_tokens(scene: Scene, epoch: int) -> tuple[Drawn, dict[str, Drawn]]:
    """The sheet of a map, and its tokens at an epoch by key."""
    picture = map_picture(scene, epoch)
    assert picture is not None
    root = ET.fromstring(svg(picture))
    found = {}
    for layer in root.iter(f"{SVG}g"):
        for group in layer.findall(f"{SVG}g[@data-token]"):
            dx, dy = _moved(layer)
            x, y = _moved(group)
            if x > -500:  # those of other epochs stand outside
                found[group.attrib["data-token"]] = _drawn(group, x + dx, y + dy)
    return Drawn(0, 0, picture.width, picture.height, "", ""), found


def _moved(group: ET.Element) -> tuple[float, float]:
    written = group.attrib.get("transform", "translate(0 0)").removeprefix("translate(").rstrip(")")
    x, y = written.split()
    return float(x), float(y)


def _drawn(group: ET.Element, x: float, y: float) -> Drawn:
    rect, circle = group.find(f"{SVG}rect"), group.find(f"{SVG}circle")
    if rect is not None:
        left, top = x + float(rect.attrib["x"]), y + float(rect.attrib["y"])
        width, height = float(rect.attrib["width"]), float(rect.attrib["height"])
    else:
        radius = float(circle.attrib["r"])
        left, top, width, height = x - radius, y - radius, 2 * radius, 2 * radius
    words = group.find(f"{SVG}text")
    text = "" if words is None else words.text or ""
    return Drawn(left, top, left + width, top + height, text, group.findtext(f"{SVG}title") or "")
