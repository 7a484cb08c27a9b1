"""A still: title, the map at one epoch, the timeline in rows that fit below it, and a legend."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from serendipity.pictures.picture import timeline_picture as timeline
from serendipity.pictures.picture.drawing import (
    FAINT_INK,
    FORMER,
    INK,
    MEETING,
    PAPER,
    WINDOW,
    Circle,
    Group,
    Picture,
    Polyline,
    Rect,
    Shape,
    Style,
    Text,
    agent_colours,
)
from serendipity.pictures.picture.map_picture import map_picture
from serendipity.pictures.scene.scene import Scene, headline, subtitle

_MARGIN: Final = 20.0
_LEAST: Final = 1000.0
_MOST_COLUMNS: Final = 15
_WIDEST_MAP: Final = 2000.0


def still(scene: Scene, epoch: int | None = None) -> Picture:
    """The picture of one epoch.

    Args:
        epoch: from 0 to the last frame's; None for the one that says most.
    """
    now = scene.key_epoch if epoch is None else epoch
    visited = _visited(scene)
    if scene.layout is not None and scene.layout.width > _WIDEST_MAP and visited:
        scene = replace(scene, layout=scene.layout.around(visited))
    city = map_picture(scene, now)
    fitting = 0 if city is None else int((city.width - timeline.LABELS) / timeline.COLUMN)
    per_row = min(timeline.columns(scene), max(_MOST_COLUMNS, fitting))
    wide = max(timeline.LABELS + per_row * timeline.COLUMN, 0 if city is None else city.width, _LEAST)
    shapes: list[Shape] = [
        Text(0, 14, headline(scene), 24, INK, "start", bold=True),
        Text(0, 46, subtitle(scene), 16, FAINT_INK, "start"),
        Text(0, 76, f"Epoch {now}: {scene.frames[now].caption}", 18, INK, "start"),
    ]
    y = 100.0
    if city is not None:
        shapes.append(Group(city.shapes, (wide - city.width) / 2, y))
        y += city.height + 10
        shapes.append(Group(tuple(_legend(scene)), 0, y))
        y += 40
    labels = timeline.lane_labels(scene)
    for first in range(0, timeline.columns(scene), per_row):
        row = timeline.timeline_picture(scene, first, min(first + per_row, timeline.columns(scene)) - 1, now)
        shapes += [Group(labels.shapes, 0, y), Group(row.shapes, timeline.LABELS, y)]
        y += row.height + 14
    body = Group(tuple(shapes), _MARGIN, _MARGIN)
    return Picture(wide + 2 * _MARGIN, y + _MARGIN, (body,), f"{headline(scene)}. {subtitle(scene)}")


def _visited(scene: Scene) -> set[str]:
    """Where the human is, would have been, and where those are who do anything."""
    acting = {scene.human, *(agent for act in scene.acts for agent in act.agents)}
    found = {place for frame in scene.frames for agent, place in frame.at.items() if agent in acting}
    former = {frame.former_at for frame in scene.frames if frame.former_at is not None}
    return found | former | set(scene.goals)


def _legend(scene: Scene) -> Iterator[Shape]:
    """Samples in a row, each with its meaning."""
    colours = agent_colours(len(scene.agents), scene.human)
    entries: list[tuple[Shape, str]] = []
    for agent in scene.lanes:
        paint = Style(colours[agent])
        human = agent == scene.human
        token = Circle(12, 12, 10, paint) if human else Rect(3, 3, 18, 18, paint, round=4)
        entries.append((token, scene.agents[agent]))
    samples: dict[str, Shape] = {
        "former": Polyline(((0, 12), (26, 12)), Style(stroke=FORMER, width=4, dash=(9, 8))),
        "window": Rect(0, 2, 22, 20, Style(WINDOW, FAINT_INK)),
        "meeting": Rect(1, 3, 20, 18, Style(PAPER, MEETING, 4), round=5),
        "together": Rect(1, 3, 20, 18, Style(PAPER, INK, 2), round=5),
    }
    entries += [(samples[kind], text) for kind, text in scene.legend.items()]
    x = 0.0
    for sample, text in entries:
        yield Group((sample, Text(32, 12, text, 16, INK, "start")), x, 0)
        x += 60 + len(text) * 9.5
