"""The timeline, a lane per agent and a column per epoch, below it the facts that change; and stills.

A still has a title, the map at one epoch, the timeline in rows that fit below it, and a legend.
"""

from collections.abc import Iterator
from itertools import accumulate
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
    Picture,
    Polyline,
    Rect,
    Shape,
    ShapeGroup,
    Style,
    Text,
    act_style,
    agent_colours,
    box,
    fitted,
    stacked,
    tint,
    wrapped,
)
from serendipity.pictures.picture.map_picture import flag, map_picture
from serendipity.pictures.picture.tree_picture import tree, tree_height, tree_labels
from serendipity.pictures.scene.scene import Act, Change, Scene, headline, scenario_lines, subtitle

COLUMN: Final = 98.0
LABELS: Final = 140.0
_NARROWEST: Final = 24.0  # an epoch, in time
_NARROWEST_ACT: Final = 56.0
_WIDE_HEAD: Final = 90.0  # an epoch with room for words
_ROW: Final = 15 * COLUMN
_HEAD: Final = 34.0
_CLOCK: Final = 16.0
_LANE: Final = 66.0
_FORMER: Final = 64.0
_SCRIPT: Final = 44.0
_FACT: Final = 34.0
_MOST_FACTS: Final = 14
_LONG: Final = 36  # letters of a label from which on it has three lines
_RULE: Final = "#d0d7de"


def column(scene: Scene) -> float:
    """The width of an epoch; in time as narrow as short actions allow, where there are many."""
    if scene.unit is None:
        return COLUMN
    shortest = min((act.duration for act in (*scene.acts, *scene.former_acts)), default=1)
    return min(COLUMN, max(_NARROWEST, _NARROWEST_ACT / shortest, _ROW / len(scene.frames)))


def lane_labels(scene: Scene) -> Picture:
    """What the lanes are called: a picture of its own, so that a page can keep it in sight."""
    colours = agent_colours(len(scene.agents), scene.human)
    shapes: list[Shape] = [Text(8, _HEAD / 2, "epoch", 14, FAINT_INK, "start")]
    if scene.unit is not None:
        shapes.append(Text(8, _HEAD, "time", 12, FAINT_INK, "start"))
    shapes += tree_labels(scene, _head(scene), LABELS)
    tops = _tops(scene)
    for agent in scene.lanes:
        text, size = fitted(scene.title(agent), LABELS - 34, 16, 10, bold=True)
        y, paint = tops[agent] + _LANE / 2, Style(colours[agent])
        person = agent in scene.people
        marker = Circle(14, y, 7, paint) if person else Rect(7.5, y - 6.5, 13, 13, paint, round=3)
        shapes += [marker, Text(26, y, text, size, INK, "start", bold=True)]
    below = [("former", _FORMER, f"{scene.agents[scene.human]}'s", "former plan")] if scene.deviates else []
    below += [("script", _SCRIPT, "what happens", "anyway")] if scene.marks else []
    for lane, height, first, second in below:
        middle = tops[lane] + height / 2
        shapes.append(Text(8, middle - 9, *fitted(first, LABELS - 12, 14, 10), FAINT_INK, "start"))
        shapes.append(Text(8, middle + 9, second, 14, FAINT_INK, "start"))
    for change, top in _fact_tops(scene):
        text = f"goal: {change.label}" if change.goal else change.label
        lines, size = wrapped(text, LABELS - 12, (12, 11, 10), 3 if len(text) > _LONG else 2)
        colour = INK if change.goal else FAINT_INK
        heights = stacked(len(lines), top + _FACT / 2, min(13, _FACT / len(lines)))
        label = [Text(8, y, line, size, colour, "start") for line, y in zip(lines, heights, strict=True)]
        shapes.append(ShapeGroup(tuple(label), title=text))
    return Picture(LABELS, _height(scene), tuple(shapes), "Lanes of the timeline")


def timeline_picture(
    scene: Scene, first: int = 0, last: int | None = None, now: int | None = None
) -> Picture:
    """The columns of epochs ``first`` (0 is the start) to ``last`` (by default the end)."""
    end = min(scene.frames[-1].epoch, scene.frames[-1].epoch if last is None else last)
    width = (end - first + 1) * column(scene)
    tops = [top for lane, top in _tops(scene).items() if lane != "facts"]
    tops += [top for _, top in _fact_tops(scene)]
    shapes = [
        *_columns(scene, first, end),
        *([Rect(0, _head(scene), width, tree_height(scene), Style(PAPER))] if scene.histories else ()),
        *([] if now is None or not first <= now <= end else [_cursor(scene, (now - first) * column(scene))]),
        *(tree(scene, _head(scene), first, end, column(scene)) if scene.histories else ()),
        *(Polyline(((0, top), (width, top)), Style(stroke=_RULE, width=1)) for top in tops),
        *_marks(scene, first, end),
        *_acts(scene, first, end),
        *_facts(scene, first, end),
    ]
    steps = [
        f"epoch {act.epoch}: {', '.join(scene.agents[i] for i in act.agents)} {act.action}"
        for act in scene.acts
    ]
    steps += [f"with epoch {epoch}: {', '.join(texts)}" for epoch, texts in scene.marks.items()]
    return Picture(width, _height(scene), tuple(shapes), f"Timeline. {'; '.join(steps)}")


def _cursor(scene: Scene, x: float) -> ShapeGroup:
    """The frame about the column of the epoch that is shown, which stands behind all words."""
    frame = Rect(1.5, 1.5, column(scene) - 3, _height(scene) - 3, Style(stroke=INK, width=3), round=8)
    return ShapeGroup((frame,), x, 0, {"cursor": ""})


def _head(scene: Scene) -> float:
    """How high the rows of epochs and clock are."""
    return _HEAD if scene.unit is None else _HEAD + _CLOCK


def _tops(scene: Scene) -> dict[int | str, float]:
    """Where the lane of each agent begins, and what is below: the former plan, the script, the facts."""
    heights: dict[int | str, float] = dict.fromkeys(scene.lanes, _LANE)
    heights["former"] = _FORMER if scene.deviates else 0
    heights |= {"script": _SCRIPT} if scene.marks else {}
    head = _head(scene) + tree_height(scene)
    return dict(zip((*heights, "facts"), accumulate(heights.values(), initial=head), strict=True))


def _fact_tops(scene: Scene) -> list[tuple[Change, float]]:
    top = _tops(scene)["facts"] + 6
    return [(change, top + i * _FACT) for i, change in enumerate(scene.changes[:_MOST_FACTS])]


def _height(scene: Scene) -> float:
    facts = _fact_tops(scene)
    return (facts[-1][1] + _FACT if facts else _tops(scene)["facts"]) + 4


def _columns(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    """The heads; each column is a group that a page can make react to clicks."""
    width, height = column(scene), _height(scene)
    for epoch in range(first, last + 1):
        inside = scene.frames[epoch].in_window
        sign = " · window" if width > _WIDE_HEAD else " *"
        words = f"{epoch}{sign}" if inside else str(epoch) if epoch else "start"
        text, size = fitted(words, width - 2, 14 if inside else 16, 8, bold=True)
        shapes: list[Shape] = [
            Rect(0, 0, width, height, Style(WINDOW if inside else PAPER)),
            Text(width / 2, _HEAD / 2, text, size, INK, bold=True),
        ]
        time = scene.clock(epoch).partition("–")[2]  # at the end of the epoch
        shapes += [Text(width - 5, _HEAD, *fitted(time, width - 8, 12, 7), FAINT_INK, "end")] if time else []
        title = "the window: the human may be met" if inside else ""
        yield ShapeGroup(tuple(shapes), (epoch - first) * width, 0, {"column": str(epoch)}, title)


def _marks(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    """What the script changes at the end of an epoch: a line through all lanes, and words before it."""
    tops, before = _tops(scene), first - 1
    for epoch, texts in scene.marks.items():
        if not first <= epoch <= last:
            continue
        middle = tops["script"] + _SCRIPT / 2
        x, room = (epoch - first + 1) * column(scene), (epoch - before) * column(scene) - 16
        lines, size = wrapped(", ".join(texts), room, (13, 12, 11, 10, 9), 3)
        heights = stacked(len(lines), middle, min(14, _SCRIPT / len(lines)))
        shapes: list[Shape] = [
            Polyline(
                ((x, tops[scene.human]), (x, _height(scene))), Style(stroke=INK, width=1.5, dash=(3, 4))
            ),
            Polyline(
                ((x - 6, middle), (x, middle - 6), (x + 6, middle), (x, middle + 6)), Style(INK), closed=True
            ),
            *(Text(x - 10, y, line, size, INK, "end") for line, y in zip(lines, heights, strict=True)),
        ]
        yield ShapeGroup(tuple(shapes), title=f"with epoch {epoch}: {', '.join(texts)}")
        before = epoch


def _acts(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    colours = agent_colours(len(scene.agents), scene.human)
    tops = _tops(scene)
    for act in scene.acts:
        if act.epoch <= last and first <= act.end:
            joint = len(act.agents) > 1
            paints = {tops[i] + _LANE / 2: act_style(colours[i], joint) for i in act.agents}
            yield _bar(scene, act, range(first, last + 1), paints, _LANE - 8, INK)
    if scene.deviates:
        former = {tops["former"] + _FORMER / 2: Style(PAPER, FORMER, 1.5, (4, 3))}
        for act in scene.former_acts:
            if act.epoch <= last and first <= act.end:
                yield _bar(scene, act, range(first, last + 1), former, _FORMER - 6, FAINT_INK)


def _bar(
    scene: Scene, act: Act, seen: range, paints: dict[float, Style], height: float, ink: str
) -> ShapeGroup:
    """An action over those of its epochs that are seen, in lanes of some middles."""
    start, end = max(seen[0], act.epoch), min(seen[-1], act.end)
    width = (end - start + 1) * column(scene)
    shapes: list[Shape] = []
    if len(paints) > 1:
        bond = Style(stroke=MEETING, width=10)
        shapes.append(Polyline(((width / 2, min(paints)), (width / 2, max(paints))), bond))
    for middle, paint in paints.items():
        shapes += box(act.verb, act.detail, width, middle, height, paint, ink)
    x = (start - seen[0]) * column(scene)
    return ShapeGroup(tuple(shapes), x, 0, {"act": str(act.epoch)}, act.action)


def _facts(scene: Scene, first: int, last: int) -> Iterator[Shape]:
    for change, top in _fact_tops(scene):
        colour = tint(GOAL if change.goal else FORMER, 0.35)
        for span in change.spans:
            start, end = max(first, span.first), min(last, span.last)
            if start > end:
                continue
            x, width = (start - first) * column(scene) + 4, (end - start + 1) * column(scene) - 8
            text, size = fitted(span.value, width - 16, 13, 10)
            bar = Rect(x, top + 4, width, _FACT - 8, Style(colour), round=6)
            yield ShapeGroup((bar, Text(x + 8, top + _FACT / 2, text, size, INK, "start")), title=span.value)


_MARGIN: Final = 20.0
_LEAST: Final = 1000.0


def still(scene: Scene, epoch: int | None = None) -> Picture:
    """The picture of one epoch, 0 to the last frame's; of the one that says most for None."""
    now = scene.key_epoch if epoch is None else epoch
    clock = f" (time {scene.clock(now)})" if scene.clock(now) else ""
    city = map_picture(scene, now)
    fitting = _ROW if city is None else max(_ROW, city.width - LABELS)
    per_row = min(len(scene.frames), int(fitting / column(scene)))
    wide = max(LABELS + per_row * column(scene), 0 if city is None else city.width, _LEAST)
    shapes: list[Shape] = [
        Text(0, 14, headline(scene), 24, INK, "start", bold=True),
        Text(0, 46, subtitle(scene), 16, FAINT_INK, "start"),
    ]
    y = 74.0
    for line, bold in ((f"{words}{' (played here)' * here}", here) for words, here in scenario_lines(scene)):
        shapes.append(Text(0, y, *fitted(line, _LEAST, 16, 8, bold=bold), INK, "start", bold=bold))
        y += 24
    caption = f"Epoch {now}{clock}: {scene.frames[now].caption}"
    shapes.append(Text(0, y + 2, caption, 18, INK, "start"))
    y += 26
    if city is not None:
        shapes.append(ShapeGroup(city.shapes, (wide - city.width) / 2, y))
        y += city.height + 10
        shapes.append(ShapeGroup(tuple(_legend(scene)), 0, y))
        y += 40
    labels = lane_labels(scene)
    for first in range(0, len(scene.frames), per_row):
        row = timeline_picture(scene, first, first + per_row - 1, now)
        shapes += [ShapeGroup(labels.shapes, 0, y), ShapeGroup(row.shapes, LABELS, y)]
        y += row.height + 14
    body = ShapeGroup(tuple(shapes), _MARGIN, _MARGIN)
    return Picture(wide + 2 * _MARGIN, y + _MARGIN, (body,), f"{headline(scene)}. {subtitle(scene)}")


def _legend(scene: Scene) -> Iterator[Shape]:
    """Samples in a row, each with its meaning."""
    colours = agent_colours(len(scene.agents), scene.human)
    entries: list[tuple[Shape, str]] = []
    for agent in scene.lanes:
        paint = Style(colours[agent])
        person = agent in scene.people
        token = Circle(12, 12, 10, paint) if person else Rect(3, 3, 18, 18, paint, round=4)
        entries.append((token, scene.title(agent)))
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
        yield ShapeGroup((sample, Text(32, 12, text, 16, INK, "start")), x, 0)
        x += 60 + len(text) * 9.5
