"""The map: places, ways, paths, and the tokens of one frame."""

from collections.abc import Iterator
from itertools import chain
from typing import Final

from serendipity.show.map.layout import Box, Layout
from serendipity.show.picture.drawing import (
    LETTER,
    Circle,
    Group,
    Line,
    Picture,
    Point,
    Rect,
    Shape,
    Style,
    Text,
    fitted,
)
from serendipity.show.picture.palette import (
    CORRIDOR,
    FAINT_INK,
    FLOOR,
    FORMER,
    GOAL,
    INK,
    MEETING,
    PAPER,
    WALL,
    agent_colours,
    on,
)
from serendipity.show.picture.tokens import (
    FORMER as FORMER_TOKEN,
)
from serendipity.show.picture.tokens import (
    PILL_HEIGHT,
    PILL_SIZE,
    RADIUS,
    Token,
    agent_key,
    initials,
    object_key,
    pill,
    tokens,
)
from serendipity.show.picture.trails import trail
from serendipity.show.scene.scene import Scene

MARGIN: Final = 14.0
_DOOR: Final = 40.0
_ROOM: Final = 4.0  # between a lone place's outline and its cell
_LABEL_SIZE: Final = 23.0
_LABEL_AT: Final = -33.0
_TAG: Final = 19.0
_TAG_AT: Final = 40.0
_FAINT: Final = 0.28
_HIDDEN: Final = (-1000.0, -1000.0)

Steps = tuple[tuple[Point, ...], ...]


def map_picture(scene: Scene, epoch: int) -> Picture | None:
    """The map after an epoch; None where the task has none.

    Groups and lines that a page moves carry ``data-token`` and ``data-trail``.
    """
    layout = scene.layout
    if layout is None:
        return None
    content = (
        *_floor(layout),
        *_trails(scene, epoch),
        *_labels(scene, layout),
        *_meetings(scene, layout),
        *_tokens(scene, epoch),
    )
    shapes = (Group(content, MARGIN, MARGIN),)
    where = "; ".join(f"{scene.agents[i]} in {place}" for i, place in scene.frames[epoch].at.items())
    description = f"Map of {len(layout.boxes)} places, epoch {epoch}: {where}"
    return Picture(layout.width + 2 * MARGIN, layout.height + 2 * MARGIN, shapes, description)


def trails(scene: Scene) -> dict[str, Steps]:
    """The lines of the former plan and of each agent, by token, as the points that each epoch adds."""
    layout = scene.layout
    if layout is None:
        return {}
    found: dict[str, Steps] = {}
    if scene.deviates:
        found[FORMER_TOKEN] = trail(layout, [frame.former_at for frame in scene.frames], 2)
    for n, agent in enumerate(scene.lanes):
        stops = [frame.at.get(agent) for frame in scene.frames]
        if not layout.boxes.keys() >= set(stops) - {None}:
            continue
        found[agent_key(agent)] = trail(layout, stops, 1 if n == 0 else n + 2)
    return found


def _floor(layout: Layout) -> Iterator[Shape]:
    in_plan = {place for door in layout.doors for place in door}
    lines = [link for link in layout.links if link not in layout.doors]
    for a, b in lines:
        if a not in in_plan:
            yield Line(layout.route(a, b), Style(stroke=WALL, width=3))
    for place, box in layout.boxes.items():
        yield _outline(box, in_plan=place in in_plan)
    for a, b in sorted(layout.doors):
        yield _door(layout.boxes[a], layout.boxes[b])
    for a, b in lines:
        if a in in_plan:  # a passage that no floor plan of a tree has room for
            yield Line(layout.route(a, b), Style(stroke=WALL, width=6, dash=(2, 9)))


def _labels(scene: Scene, layout: Layout) -> Iterator[Shape]:
    """Above the paths, on the colour of the floor so that both can be read."""
    for place, box in layout.boxes.items():
        goal = place in scene.goals
        label, size = fitted(place, box.width - (38 if goal else 14), _LABEL_SIZE, 13)
        x, y, width = box.x + (10 if goal else 0), box.y + _LABEL_AT, len(label) * size * LETTER
        floor = Style(CORRIDOR if box.corridor else FLOOR, opacity=0.85)
        yield Rect(x - width / 2, y - size / 2, width, size, floor, round=4)
        yield Text(x, y, label, size, FAINT_INK)
        if goal:
            yield _flag(x - width / 2 - 18, box.y + _LABEL_AT)


def _outline(box: Box, *, in_plan: bool) -> Rect:
    inset = 0 if in_plan else _ROOM
    return Rect(
        box.x - box.width / 2 + inset,
        box.y - box.height / 2 + inset,
        box.width - 2 * inset,
        box.height - 2 * inset,
        Style(CORRIDOR if box.corridor else FLOOR, WALL, 2 if in_plan else 3),
        round=0 if in_plan else 14,
    )


def _door(a: Box, b: Box) -> Line:
    """The opening in the wall between two boxes, in the colour of the floor."""
    floor = Style(stroke=CORRIDOR if a.corridor or b.corridor else FLOOR, width=5)
    if a.y == b.y:
        left = a if a.x < b.x else b
        x = left.x + left.width / 2
        return Line(((x, a.y - _DOOR / 2), (x, a.y + _DOOR / 2)), floor)
    narrow, upper = (a if a.width < b.width else b), (a if a.y < b.y else b)
    y = upper.y + upper.height / 2
    return Line(((narrow.x - _DOOR / 2, y), (narrow.x + _DOOR / 2, y)), floor)


def _flag(x: float, y: float) -> Group:
    pole = Line(((x, y - 10), (x, y + 10)), Style(stroke=INK, width=2))
    cloth = Line(((x, y - 10), (x + 14, y - 5), (x, y)), Style(GOAL, INK, 1), closed=True)
    return Group((pole, cloth), title="the human's goal")


def _trails(scene: Scene, epoch: int) -> Iterator[Shape]:
    colours = {agent_key(i): c for i, c in agent_colours(len(scene.agents), scene.human).items()}
    for key, steps in trails(scene).items():
        whole = tuple(chain.from_iterable(steps))
        if key == FORMER_TOKEN:
            yield Line(whole, Style(stroke=FORMER, width=4, dash=(9, 8)), data={"ghost": key})
            continue
        yield Line(whole, Style(stroke=colours[key], width=4, opacity=_FAINT))
        done = tuple(chain.from_iterable(steps[: epoch + 1]))
        yield Line(done, Style(stroke=colours[key], width=5), data={"trail": key})


def _meetings(scene: Scene, layout: Layout) -> Iterator[Shape]:
    for index, meeting in enumerate(scene.meetings):
        if meeting.place is None:
            continue
        box = layout.boxes[meeting.place]
        x, y = box.x - box.width / 2, box.y - box.height / 2
        frame = Rect(x + 4, y + 4, box.width - 8, box.height - 8, Style(stroke=MEETING, width=5), round=12)
        text = f"epoch {meeting.epoch}"
        middle = box.y + _TAG_AT
        tag = Rect(box.x - 38, middle - _TAG / 2, 76, _TAG, Style(MEETING), round=_TAG / 2)
        words = Text(box.x, middle, text, 16, INK, bold=True)
        yield Group((frame, tag, words), data={"meeting": str(index)}, title=meeting.text)


def _tokens(scene: Scene, epoch: int) -> Iterator[Shape]:
    """All tokens that any frame shows; those that this one lacks stand outside the picture."""
    frame = scene.frames[epoch]
    now = tokens(scene, frame)
    ever = {key for each in scene.frames for key in tokens(scene, each)}
    colours = agent_colours(len(scene.agents), scene.human)
    letters = initials(scene.agents)
    if FORMER_TOKEN in ever:
        shapes = _person(letters[scene.human], PAPER, FORMER, dashed=True)
        title = f"{scene.agents[scene.human]} with the former plan"
        yield _token(FORMER_TOKEN, now, shapes, title)
    for agent in scene.lanes:
        if agent_key(agent) in ever:
            paint = _person if agent == scene.human else _machine
            yield _token(agent_key(agent), now, paint(letters[agent], colours[agent]), scene.agents[agent])
    for index, name in enumerate(frame.objects):
        key = object_key(index)
        if key in ever:
            holder = now[key].holder if key in now else None
            yield _token(key, now, _pill(name, None if holder is None else colours[holder]), name)


def _pill(name: str, holder: str | None) -> tuple[Shape, ...]:
    """An object; its outline takes the colour of who holds it."""
    text, width = pill(name)
    style = Style(PAPER, INK, 2) if holder is None else Style(PAPER, holder, 3.5)
    half = PILL_HEIGHT / 2
    return Rect(-width / 2, -half, width, PILL_HEIGHT, style, round=half), Text(0, 0, text, PILL_SIZE, INK)


def _token(key: str, now: dict[str, Token], shapes: tuple[Shape, ...], title: str) -> Group:
    x, y = now[key].at if key in now else _HIDDEN
    return Group(shapes, x, y, {"token": key}, title)


def _person(letter: str, fill: str, stroke: str = PAPER, *, dashed: bool = False) -> tuple[Shape, ...]:
    style = Style(fill, stroke, 2.5, (5, 4) if dashed else ())
    return Circle(0, 0, RADIUS, style), _letter(letter, FORMER if dashed else on(fill))


def _machine(letter: str, fill: str) -> tuple[Shape, ...]:
    side = 2 * RADIUS - 2
    square = Rect(-side / 2, -side / 2, side, side, Style(fill, PAPER, 2.5), round=5)
    return square, _letter(letter, on(fill))


def _letter(letter: str, colour: str) -> Text:
    return Text(0, 0, letter, 20 if len(letter) < 2 else 16, colour, bold=True)
