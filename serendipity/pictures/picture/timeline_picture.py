"""The timeline, a lane per agent and a column per epoch, below it the facts that change; and stills.

A still has a title, the map at one epoch, the timeline in rows that fit below it, and a legend.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from serendipity.pictures.picture.drawing import (
    FAINT_INK,
    FORMER,
    GOAL,
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
    fitted,
    tint,
    wrapped,
)
from serendipity.pictures.picture.map_picture import flag, map_picture
from serendipity.pictures.scene.scene import Act, Change, Scene, headline, subtitle

COLUMN: Final = 98.0
LABELS: Final = 140.0
_HEAD: Final = 34.0
_LANE: Final = 66.0
_FORMER: Final = 64.0
_FACT: Final = 34.0
_MOST_FACTS: Final = 14
_LONG: Final = 36  # letters of a label from which on it has three lines
_RULE: Final = "#d0d7de"


def columns(scene: Scene) -> int:
    """How many columns the timeline has: the start, and one per epoch."""
    return len(scene.frames)


def lane_labels(scene: Scene) -> Picture:
    """What the lanes are called: a picture of its own, so that a page can keep it in sight."""
    colours = agent_colours(len(scene.agents), scene.human)
    shapes: list[Shape] = [Text(8, _HEAD / 2, "epoch", 14, FAINT_INK, "start")]
    for agent, top in _lane_tops(scene).items():
        text, size = fitted(scene.agents[agent], LABELS - 34, 16, 11, bold=True)
        y, paint = top + _LANE / 2, Style(colours[agent])
        own = agent == scene.human
        marker = Circle(14, y, 7, paint) if own else Rect(7.5, y - 6.5, 13, 13, paint, round=3)
        shapes += [marker, Text(26, top + _LANE / 2, text, size, INK, "start", bold=True)]
    if scene.deviates:
        middle = _former_top(scene) + _FORMER / 2
        text, size = fitted(f"{scene.agents[scene.human]}'s", LABELS - 12, 14, 10)
        shapes += [
            Text(8, middle - 9, text, size, FAINT_INK, "start"),
            Text(8, middle + 9, "former plan", 14, FAINT_INK, "start"),
        ]
    for change, top in _fact_tops(scene):
        text = f"goal: {change.label}" if change.goal else change.label
        lines, size = wrapped(text, LABELS - 12, (12, 11, 10), 3 if len(text) > _LONG else 2)
        colour = INK if change.goal else FAINT_INK
        heights = _stacked(len(lines), top + _FACT / 2, min(13, _FACT / len(lines)))
        label = [Text(8, y, line, size, colour, "start") for line, y in zip(lines, heights, strict=True)]
        shapes.append(Group(tuple(label), title=text))
    return Picture(LABELS, _height(scene), tuple(shapes), "Lanes of the timeline")


def timeline_picture(
    scene: Scene, first: int = 0, last: int | None = None, now: int | None = None
) -> Picture:
    """The columns of epochs ``first`` to ``last``.

    Args:
        first: the first epoch; 0 is the start.
        last: the last epoch; None for the end.
        now: the epoch that is marked.
    """
    end = columns(scene) - 1 if last is None else last
    width = (end - first + 1) * COLUMN
    tops = [*_lane_tops(scene).values(), _former_top(scene), *(top for _, top in _fact_tops(scene))]
    shapes = [
        *_columns(scene, first, end),
        *_window(scene, first, end),
        *(Polyline(((0, top), (width, top)), Style(stroke=_RULE, width=1)) for top in tops),
        *_acts(scene, first, end),
        *_facts(scene, first, end),
    ]
    if now is not None and first <= now <= end:
        shapes.append(cursor(scene, (now - first) * COLUMN))
    steps = [
        f"epoch {act.epoch}: {', '.join(scene.agents[i] for i in act.agents)} {act.action}"
        for act in scene.acts
    ]
    return Picture(width, _height(scene), tuple(shapes), f"Timeline. {'; '.join(steps)}")


def cursor(scene: Scene, x: float = 0.0) -> Group:
    """The frame about the column of the epoch that is shown."""
    frame = Rect(1.5, 1.5, COLUMN - 3, _height(scene) - 3, Style(stroke=INK, width=3), round=8)
    return Group((frame,), x, 0, {"cursor": ""})


def _lane_tops(scene: Scene) -> dict[int, float]:
    return {agent: _HEAD + i * _LANE for i, agent in enumerate(scene.lanes)}


def _former_top(scene: Scene) -> float:
    return _HEAD + len(scene.lanes) * _LANE


def _fact_tops(scene: Scene) -> list[tuple[Change, float]]:
    top = _former_top(scene) + (_FORMER if scene.deviates else 0) + 6
    return [(change, top + i * _FACT) for i, change in enumerate(scene.changes[:_MOST_FACTS])]


def _height(scene: Scene) -> float:
    facts = _fact_tops(scene)
    return (facts[-1][1] + _FACT if facts else _former_top(scene) + (_FORMER if scene.deviates else 0)) + 4


def _columns(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    """The heads; each column is a group that a page can make react to clicks."""
    height = _height(scene)
    for epoch in range(first, last + 1):
        x = (epoch - first) * COLUMN
        area = Rect(0, 0, COLUMN, height, Style(PAPER))
        head = Text(COLUMN / 2, _HEAD / 2, str(epoch) if epoch else "start", 16, INK, bold=True)
        yield Group((area, head), x, 0, {"column": str(epoch)})


def _window(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    if scene.window is None:
        return
    start, end = max(first, scene.window.start), min(last + 1, scene.window.end)
    for epoch in range(start, end):
        x = (epoch - first) * COLUMN
        area = Rect(0, 0, COLUMN, _height(scene), Style(WINDOW))
        head = Text(COLUMN / 2, _HEAD / 2, f"{epoch} · window", 14, INK, bold=True)
        yield Group((area, head), x, 0, {"column": str(epoch)}, "the window: the human may be met")


def _acts(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    colours = agent_colours(len(scene.agents), scene.human)
    tops = _lane_tops(scene)
    for act in scene.acts:
        if not first <= act.epoch <= last:
            continue
        x = (act.epoch - first) * COLUMN
        shapes: list[Shape] = []
        middles = [tops[agent] + _LANE / 2 for agent in act.agents]
        if len(middles) > 1:
            bond = Style(stroke=MEETING, width=10)
            shapes.append(Polyline(((COLUMN / 2, min(middles)), (COLUMN / 2, max(middles))), bond))
        joint = len(act.agents) > 1
        for agent, middle in zip(act.agents, middles, strict=True):
            edge = MEETING if joint else colours[agent]
            paint = Style(tint(colours[agent]), edge, 3.5 if joint else 1.5)
            shapes += _label(act, middle, _LANE - 8, paint, INK)
        yield Group(tuple(shapes), x, 0, {"act": str(act.epoch)}, act.action)
    if scene.deviates:
        yield from _former(scene, first, last)


def _former(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    middle = _former_top(scene) + _FORMER / 2
    for act in scene.former_acts:
        if first <= act.epoch <= last:
            shapes = _label(act, middle, _FORMER - 6, Style(PAPER, FORMER, 1.5, (4, 3)), FAINT_INK)
            x = (act.epoch - first) * COLUMN
            yield Group(tuple(shapes), x, 0, {"act": str(act.epoch)}, act.action)


def _label(act: Act, middle: float, height: float, paint: Style, ink: str) -> list[Shape]:
    """A box with the action in two to four lines, the detail, which tells it from others, in bold."""
    width = COLUMN - 8
    verb, small = wrapped(act.verb, width - 4, (13, 12, 11))
    detail, large = wrapped(act.detail, width - 6, (14, 12, 11, 10, 9), 4 - len(verb), bold=True)
    lines = [(line, small, False) for line in verb] + [(line, large, True) for line in detail if line]
    heights = _stacked(len(lines), middle, min(16, (height - 4) / len(lines)))
    shapes: list[Shape] = [Rect(4, middle - height / 2, width, height, paint, round=8)]
    shapes += [
        Text(COLUMN / 2, y, line, size, ink, bold=bold)
        for (line, size, bold), y in zip(lines, heights, strict=True)
    ]
    return shapes


def _stacked(lines: int, middle: float, step: float) -> list[float]:
    """Heights of lines about a middle."""
    return [middle + (i - (lines - 1) / 2) * step for i in range(lines)]


def _facts(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    for change, top in _fact_tops(scene):
        colour = tint(GOAL if change.goal else FORMER, 0.35)
        for span in change.spans:
            start, end = max(first, span.first), min(last, span.last)
            if start > end:
                continue
            x, width = (start - first) * COLUMN + 4, (end - start + 1) * COLUMN - 8
            text, size = fitted(span.value, width - 16, 13, 10)
            bar = Rect(x, top + 4, width, _FACT - 8, Style(colour), round=6)
            yield Group((bar, Text(x + 8, top + _FACT / 2, text, size, INK, "start")), title=span.value)


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
    fitting = 0 if city is None else int((city.width - LABELS) / COLUMN)
    per_row = min(columns(scene), max(_MOST_COLUMNS, fitting))
    wide = max(LABELS + per_row * COLUMN, 0 if city is None else city.width, _LEAST)
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
    labels = lane_labels(scene)
    for first in range(0, columns(scene), per_row):
        row = timeline_picture(scene, first, min(first + per_row, columns(scene)) - 1, now)
        shapes += [Group(labels.shapes, 0, y), Group(row.shapes, LABELS, y)]
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
    if scene.goals:
        entries.append((flag(8, 12), "goal"))
    x = 0.0
    for sample, text in entries:
        yield Group((sample, Text(32, 12, text, 16, INK, "start")), x, 0)
        x += 60 + len(text) * 9.5
